// Makes a page of the book ready for paper: see pdf.py, which calls these.
window.paper = (() => {
  const all = (selector, root = document) => [...root.querySelectorAll(selector)];
  const LONG = 12; // lines: a longer listing is read in the chapter's notebook
  const FOOT = 'font: 8.5pt sans-serif; color: #57606a';
  const titleOf = (section) => section?.querySelector(':scope > :is(h1, h2, h3, h4)');
  const wordsOf = (title) => {
    const copy = title.cloneNode(true);
    all('.headerlink', copy).forEach((it) => it.remove());
    return copy.textContent.trim();
  };

  // Whether each panel stands there, answered and drawn.
  const drawn = () => all('script[type$="widget-view+json"]').every((it) =>
    it.parentElement.querySelector('.jupyter-widgets'))
      && all('.live').every((it) => it.dataset.open === 'true')
      && all('.my-robot').every((it) => it.dataset.done === 'true')
      && all('.jupyter-widgets canvas').every((it) => it.width);

  // Returns the anchors of the chapters, of which a list stands before them.
  async function prepare() {
    await MathJax.startup.promise;
    await document.fonts.ready;
    document.documentElement.dataset.theme = 'light';
    for (const fold of all('details')) {
      const lines = all('.line', fold).map((it) => it.textContent);
      const short = lines.length <= LONG && !lines.some((it) => /^(import|from) /.test(it));
      fold.open = !fold.matches('.above-input') || short; // solutions, where there are any
    }
    for (const it of all('.cell.tag_hide-cell'))
      if (it.textContent.includes('# Check')) it.remove(); // for whoever has changed a number
    for (const it of all('.cell_output'))
      if (/^\s*Hint: /.test(it.textContent)) it.remove(); // an answer is still to be written
    for (const it of all('.cell'))
      if (![...it.children].some((part) => part.checkVisibility())) it.remove();
    all('img').forEach((it) => { it.loading = 'eager'; });
    // Sphinx writes #document-notebooks/04_lyapunov#paper-24
    for (const link of all('a[href^="#document-"]')) {
      const [, place, part] = link.getAttribute('href').split('#');
      if (part && document.getElementById(part)) link.href = `#${part}`;
      else link.href = `#${place}`;
    }
    await Promise.all(all('img').map((it) => it.decode().catch(() => {})));
    return asBook();
  }

  // The documents on one page become chapters, with a list of them before; none, no book.
  function asBook() {
    const starts = all('span[id^="document-"]').filter((it) => titleOf(it.nextElementSibling));
    if (!starts.length) return [];
    const list = document.createElement('nav'), feet = document.createElement('style');
    list.className = 'paper-contents';
    starts[0].parentElement.before(list);
    const parts = all('#pst-page-toc-nav .caption');
    list.append(paragraph('Contents'));
    document.head.append(feet);
    return starts.map((start, k) => {
      const chapter = start.nextElementSibling, title = titleOf(chapter);
      const words = wordsOf(title), link = document.createElement('a');
      const part = parts.find((it) =>
        it.nextElementSibling.querySelector('a').hash === `#${start.id}`);
      if (part) list.append(paragraph(part.textContent));
      title.id = `chapter-${k}`; // no other document has it
      title.classList.add('paper-title');
      link.href = `#${title.id}`;
      link.append(words, document.createElement('span'));
      list.append(link);
      chapter.classList.add('paper-chapter');
      chapter.prepend(start); // or a link to the chapter leads to the page before
      chapter.style.page = title.id;
      const foot = `content: ${JSON.stringify(words)}; ${FOOT}`;
      feet.append(`@page ${title.id} { @bottom-left { ${foot} } }`);
      nameLive(chapter, /^\d+(?=\.)/.exec(words)?.[0]);
      return title.id;
    });
  }

  // Live pictures that have no caption are numbered, so that a class can speak of them.
  function nameLive(chapter, number) {
    const live = all('.cell:has(.wmr):not(:has(+ .figure-caption))', chapter);
    if (number) live.forEach((it, k) => {
      const name = paragraph(''), bold = document.createElement('strong');
      name.className = 'figure-caption';
      bold.append(`Live picture ${number}.${k + 1}`);
      name.append(bold, ', which moves on the book\u2019s page.');
      it.append(name);
    });
  }

  function paragraph(words) {
    const made = document.createElement('p');
    made.append(words);
    return made;
  }

  const number = (pages) => all('.paper-contents span').forEach((it, k) => {
    it.textContent = pages[k];
  });
  return { drawn, prepare, number };
})();
