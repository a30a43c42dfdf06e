// Makes a page of the book ready for paper: see pdf.py, which calls these.
window.paper = (() => {
  const all = (selector, root = document) => [...root.querySelectorAll(selector)];
  const LONG = 12; // lines: a longer listing is read in the chapter's notebook
  const chapters = () =>
    all('span[id^="document-"]').map((it) => it.nextElementSibling).filter(titleOf);
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
    if (!chapters().length) return [];
    const list = document.createElement('nav');
    list.className = 'paper-contents';
    const anchors = chapters().map((chapter, k) => {
      const title = titleOf(chapter), link = document.createElement('a');
      title.id = `chapter-${k}`; // no other document has it
      link.href = `#${title.id}`;
      link.append(wordsOf(title), document.createElement('span'));
      list.append(link);
      return title.id;
    });
    chapters()[0].parentElement.before(list);
    return anchors;
  }

  const number = (pages) => all('.paper-contents span').forEach((it, k) => {
    it.textContent = pages[k];
  });
  return { drawn, prepare, number };
})();
