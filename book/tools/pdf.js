// The single page that holds the whole book, made ready for paper: see pdf.py, which calls these.
window.paper = (() => {
  const panels = () =>
      [...document.querySelectorAll('script[type="application/vnd.jupyter.widget-view+json"]')];
  const begins = () => [...document.querySelectorAll('span[id^="document-"]')];
  const title = (section) => section.querySelector(':scope > :is(h1, h2, h3, h4)');

  // The document that each panel is in, such as notebooks/04_lyapunov.
  const places = () => panels().map((panel) => begins()
    // the front page has none
    .filter((it) => it.compareDocumentPosition(panel) & Node.DOCUMENT_POSITION_FOLLOWING)
        .at(-1)?.id.replace('document-', '') ?? 'index');

  // Pictures in place of the panels, links that lead within the page, contents, and room for page
  // numbers.
  async function prepare(stills) {
    panels().forEach((it, k) => {
      const still = document.createElement('img');
      Object.assign(still,
          { src: stills[k], alt: 'The live panel, as its page opens it.', className: 'still' });
      it.after(still);
    });
    document.querySelectorAll('details').forEach((it) => { it.open = true; });
    document.querySelectorAll('img').forEach((it) => { it.loading = 'eager'; });
    // a line in bold type, or one that announces what follows
    for (const it of document.querySelectorAll('article p:not(td p)')) {
      const bold = it.querySelector(':scope > strong');
      it.classList.toggle('leads-on',
          /:\s*$/.test(it.textContent) || bold?.textContent === it.textContent);
    }
    mend_links();
    begins()[0].before(contents());
    for (const link of [...document.querySelectorAll('article a[href^="#"]')]) {
      const number = document.createElement('span');
      number.className = 'page-number';
      number.dataset.of = link.getAttribute('href').slice(1);
      if (link.closest('.contents-on-paper')) link.append(number);
      else if (leads_elsewhere(link)) link.after(' ', number);
    }
    number_pages({});
    await MathJax.startup.promise;
    await Promise.all([...document.images].map((it) => it.decode()));
  }

  // Sphinx writes #document-notebooks/04_lyapunov#paper-24, and several chapters have a section of
  // the same name.
  function mend_links() {
    const links = Map.groupBy(document.querySelectorAll('article a[href^="#"]'),
        (it) => it.getAttribute('href'));
    // what is empty has no place on paper
    const whole = (it) => it.matches('.math > span') ? it.parentElement : it;
    const lead = (found, target) => found?.forEach((link) => {
      link.href = `#${whole(target).id}`;
    });
    const seen = new Set([document.querySelector('article section').id]);
    for (const begin of begins()) {
      const chapter = begin.nextElementSibling;
      for (const it of [chapter,
          ...chapter.querySelectorAll('section[id], span[id], div[id], dt[id], p[id]')]) {
        const id = it.id;
        if (seen.has(id)) {
          it.id = `${begin.id.replace('document-', '')}-${id}`;
          lead(links.get(`#${id}`)?.filter((link) => chapter.contains(link)), it);
        }
        seen.add(id);
        lead(links.get(`#${begin.id}#${id}`), it);
      }
      lead(links.get(`#${begin.id}`), chapter);
    }
  }

  function contents() {
    const list = document.createElement('nav');
    list.className = 'contents-on-paper';
    list.innerHTML = '<h2>Contents</h2>';
    for (const { nextElementSibling: chapter } of begins()) {
      for (const section of [chapter, ...chapter.querySelectorAll(':scope > section')]) {
        if (!title(section)) continue;
        const line = document.createElement('a');
        line.href = `#${section.id}`;
        line.className = section === chapter ? 'of-a-chapter' : 'of-a-section';
        const words = title(section).cloneNode(true);
        words.querySelectorAll('.headerlink').forEach((it) => it.remove());
        line.append(...words.childNodes);
        list.append(line);
      }
    }
    return list;
  }

  // From one document into another: there a reader on paper has to turn pages.
  function leads_elsewhere(link) {
    const target = document.getElementById(link.getAttribute('href').slice(1));
    const chapter = (it) => it?.closest('span[id^="document-"] + section');
    return chapter(target) && chapter(link) && chapter(target) !== chapter(link)
        && !link.closest('pre, table, .headerlink');
  }

  // `pages` tells where an anchor was printed; "000" keeps its place before anything is.
  function number_pages(pages) {
    for (const number of document.querySelectorAll('.page-number')) {
      const page = pages[number.dataset.of] ?? '000';
      number.textContent = number.closest('.contents-on-paper') ? ` ${page}` : `[p. ${page}]`;
    }
  }

  const anchors = () =>
      [...new Set([...document.querySelectorAll('.page-number')].map((it) => it.dataset.of))];
  return { places, prepare, number_pages, anchors };
})();
