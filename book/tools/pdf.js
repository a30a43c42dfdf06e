// The single page that holds the whole book, made ready for paper: see pdf.py, which calls these.
window.paper = (() => {
  const { all, made, title, wordsOf, begins, nameOf, places, states, still, solutions, unfold } =
      window.parts;

  // Sphinx writes #document-notebooks/04_lyapunov#paper-24, and several chapters have a section of
  // the same name.
  function mend_links() {
    const links = Map.groupBy(all('article a[href^="#"]'), (it) => it.getAttribute('href'));
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
          it.id = `${nameOf(begin)}-${id}`;
          lead(links.get(`#${id}`)?.filter((link) => chapter.contains(link)), it);
        }
        seen.add(id);
        lead(links.get(`#${begin.id}#${id}`), it);
      }
      lead(links.get(`#${begin.id}`), chapter);
    }
  }

  const line = (id, className, ...words) => {
    const it = made('a', className, words.length ? '<span></span>' : '');
    it.href = `#${id}`;
    it.firstChild?.append(...words);
    return it;
  };
  const heading = (section) => {
    const words = title(section).cloneNode(true);
    all('.headerlink, .number', words).forEach((it) => it.remove());
    all('[id]', words).forEach((it) => it.removeAttribute('id'));
    return [section.dataset.number || '', ...words.childNodes];
  };
  function contents(chapters) {
    const list = made('nav', 'matter lines contents-on-paper', '<h3>Contents</h3>');
    for (const chapter of chapters) {
      for (const section of [chapter, ...all(':scope > section', chapter)]) {
        if (title(section) && !/^(Exercises|Summary)$/.test(wordsOf(title(section)))
            && (section === chapter || chapter.id !== 'solutions'))
          list.append(line(section.id, section === chapter ? 'of-a-chapter' : 'of-a-section',
              ...heading(section)));
      }
    }
    return list;
  }
  function figures() {
    const list = made('nav', 'matter lines figures-on-paper', '<h3>Figures</h3>');
    for (const caption of all('.figure-caption')) {
      const [number, says] = wordsOf(caption).match(/Figure ([\d.]+)\. (.*?)(?=[.;:] |[.]$|$)/s)
          .slice(1);
      list.append(line(caption.id, '', made('b', '', number), says));
    }
    return list;
  }

  // Where a term is explained, in a heading or in other type, or else where a chapter first
  // says it.
  function index(terms) {
    const back = made('section', 'matter index-on-paper', '<h3>Index</h3><div></div>');
    back.id = 'index';
    const walker = document.createTreeWalker(document.querySelector('article'),
        NodeFilter.SHOW_TEXT, (node) => {
      const it = node.parentElement;
      return it.closest('pre, code, script, mjx-container, a, dl, .citation, .prediction, figure')
          || !it.closest('.chapter') ? NodeFilter.FILTER_REJECT : NodeFilter.FILTER_ACCEPT;
    });
    const nodes = [];
    while (walker.nextNode()) nodes.push(walker.currentNode);
    const lost = [];
    let last = '';
    terms.forEach(([term, pattern], k) => {
      const sought = RegExp(`(?<![\\w-])(?:${pattern})(?!\\w)`, 'i'), places = new Map();
      for (const node of nodes) {
        if (!sought.test(node.data)) continue;
        const chapter = node.parentElement.closest('.chapter').id;
        const main = Boolean(node.parentElement.closest('h3, h4, h5, strong, em'));
        const known = places.get(chapter);
        if (!known || (main && !known.main)) places.set(chapter, { node, main });
      }
      if (!places.size) { lost.push(term); return; }
      const row = made('p', term[0].toUpperCase() !== last ? 'begins' : '');
      last = term[0].toUpperCase();
      row.append(term);
      const told = [...places].filter(([, it]) => it.main);
      for (const [chapter, { node }] of told.length ? told : [...places].slice(0, 4)) {
        // a heading's place is its section's: alone it may be looked for a page too early
        const home = node.parentElement.closest('h3, h4, h5')?.parentElement;
        if (home) { row.append(', ', line(home.id, 'indexed')); continue; }
        const found = node.data.match(sought), mark = made('span', 'term', found[0]);
        mark.id = `term-${k}-${chapter}`;
        const rest = node.splitText(found.index);
        rest.data = rest.data.slice(found[0].length);
        rest.before(mark);
        nodes.splice(nodes.indexOf(node) + 1, 0, rest);
        row.append(', ', line(mark.id, 'indexed'));
      }
      back.lastChild.append(row);
    });
    if (lost.length)
      throw new Error(`The book does not say what its index has: ${lost.join(', ')}.`);
    return back;
  }

  // Each chapter's pages have its name, and their heads its title.
  function name_pages(chapters) {
    const head = 'font: 8.5pt "Paper Sans"; color: #57606a; vertical-align: bottom;'
        + ' padding-bottom: 5mm; white-space: nowrap';
    const book = wordsOf(document.querySelector('.title-page h1'));
    const rules = chapters.map((chapter, k) => {
      chapter.style.page = `p${k}`;
      const says = JSON.stringify((chapter.dataset.number || '') + wordsOf(title(chapter)));
      return `@page p${k} { @top-left { ${head} } @top-right { ${head} } }
        @page p${k}:left {
          @top-left { content: counter(page) } @top-right { content: ${JSON.stringify(book)} }
        }
        @page p${k}:right { @top-left { content: ${says} } @top-right { content: counter(page) } }`;
    });
    document.head.append(made('style', '', rules.join('\n')));
  }

  // The theme's sheets go, and what only a screen has use for.
  async function prepare(states, front, terms) {
    await MathJax.startup.promise;
    for (const it of all('link[rel="stylesheet"]'))
      if (!/pygments|face|book\.css/.test(it.href)) it.remove();
    const article = document.querySelector('article.bd-article');
    document.body.replaceChildren(article);
    article.className = document.body.className = '';
    document.documentElement.dataset.theme = 'light';
    const answers = still(states), solved = solutions();
    all('.headerlink, .copybtn, .run-it, .figure-size, .sd-container-fluid, .only-dark, script, '
        + '.edition, .colour-mode').forEach((it) => it.remove());
    unfold();
    all('.cell').filter((it) => !it.textContent.trim() && !it.querySelector('img'))
        .forEach((it) => it.remove());
    all('img').forEach((it) => { it.loading = 'eager'; });
    // a mark before its word, which no font of ours has
    all('article td, article td *').forEach((it) => { if (/^[✓✗✎] /.test(it.firstChild?.data))
      it.firstChild.data = it.firstChild.data.slice(2); });
    // a line in bold type, or one that announces what follows
    for (const it of all('article p:not(td p)')) {
      const bold = it.querySelector(':scope > strong');
      if (/:\s*$/.test(it.textContent) || bold?.textContent === it.textContent)
        it.classList.add('leads-on');
    }
    for (const caption of all('.figure-caption')) // which stays with its figure
      all('.figure-box', caption.previousElementSibling).at(-1)?.append(caption);
    mend_links();
    const scene = article.querySelector('figure'), whole = article.querySelector('section');
    const chapters = begins().map((it) => it.nextElementSibling);
    const preface = made('section', 'chapter', '<h3>Preface</h3>');
    preface.id = 'preface';
    title(whole).remove();
    preface.append(...[...whole.childNodes].filter((it) =>
      !it.classList?.contains('toctree-wrapper')));
    all('h2', preface).forEach((it) => it.replaceWith(made('h4', '', it.innerHTML)));
    chapters.forEach((it) => {
      it.classList.add('chapter');
      // a page may have sections above its chapters
      const deeper = 3 - Number(title(it).tagName[1]);
      for (const each of deeper ? all('h2, h3, h4, h5', it) : [])
        each.replaceWith(made(`h${Number(each.tagName[1]) + deeper}`, '', each.innerHTML));
      const words = title(it).firstChild, numbered = words.data?.match(/^(\d+)\. /);
      if (numbered) {
        words.data = words.data.slice(numbered[0].length);
        words.before(made('span', 'number', `${numbered[1]}.\u00a0`));
        it.dataset.number = `${numbered[1]}\u2002`;
      }
    });
    const backs = [answers, solved].filter((it) => it.children.length > 1);
    scene.closest('.cell').remove();
    article.replaceChildren(...made('div', '', front).children, preface, ...chapters, ...backs);
    article.querySelector('.subtitle').after(scene.querySelector('img'));
    const listed = index(terms);
    preface.before(contents([preface, ...chapters, ...backs, listed]), figures());
    article.append(listed);
    const sought = made('div', ''); // Chromium tells the places of links alone
    sought.hidden = true;
    for (const link of all('article a[href^="#"]')) {
      const number = made('span', 'page-number');
      number.dataset.of = firstOf(link.getAttribute('href').slice(1));
      sought.append(line(number.dataset.of, ''));
      if (link.closest('.lines, .indexed')) link.append(number);
      else if (leads_elsewhere(link)) link.after(' ', number);
    }
    article.append(sought);
    name_pages(all('.chapter, .matter'));
    mark_pictures();
    measure();
    return document.documentElement.outerHTML;
  }

  // What is printed on the page of a section's heading: Chromium may place the heading itself on
  // the page before, where it first tried it.
  function firstOf(id) {
    let it = document.getElementById(id);
    while (it?.matches('section') && title(it)) it = title(it).nextElementSibling;
    if (!it) return id;
    it.id ||= `first-of-${id}`;
    return it.id;
  }

  // From one document into another: there a reader on paper has to turn pages.
  function leads_elsewhere(link) {
    const target = document.getElementById(link.getAttribute('href').slice(1));
    const chapter = (it) => it?.closest('.chapter, .matter');
    return chapter(target) && chapter(link) && chapter(target) !== chapter(link)
        && !link.closest('pre, table, .headerlink');
  }

  // Before each picture, and what holds on to it, an empty place: where the page before it ends.
  function mark_pictures() {
    all('.figure-box, figure').forEach((picture, k) => {
      let first = picture;
      if (!picture.previousElementSibling?.matches('.prediction, .answer'))
        first = picture.closest('.cell') || picture;
      for (;;) {
        const before = first.previousElementSibling;
        if (before?.matches('h4, h5, .leads-on')) first = before;
        else if (!before && first.parentElement.matches('section section'))
          first = first.parentElement;
        else break;
      }
      const place = made('div', '');
      place.id = `above-${k}`;
      first.before(place);
      picture.id = `picture-${k}`;
      for (const id of [place.id, picture.id])
        picture.append(Object.assign(line(id, 'place'), { hidden: true }));
    });
  }

  // `pages` tells where an anchor was printed, and `heights` how high a picture may be, in mm.
  function fill(pages, heights) {
    for (const number of all('.page-number')) {
      const page = pages[number.dataset.of] ?? number.dataset.guess;
      number.textContent = number.closest('.lines, .indexed') ? `${page}` : `[p. ${page}]`;
    }
    for (const [id, height] of Object.entries(heights))
      for (const it of all('img', document.getElementById(id)))
        it.style.maxHeight = `${height}mm`;
    for (const row of all('.index-on-paper p')) { // each page once
      const seen = new Set();
      for (const link of all('.indexed', row)) {
        if (seen.has(link.textContent)) {
          link.previousSibling.remove();
          link.remove();
        }
        seen.add(link.textContent);
      }
    }
  }

  // About the page that each number will tell, so that few lines move when it is known; and of each
  // picture how high it is, and how high with all that holds on to it, in mm.
  function measure() {
    document.body.style.width = '151mm';
    const MM = 96 / 25.4, page = 0.93 * 218 * MM, top = (it) => it.getBoundingClientRect().top;
    for (const number of all('.page-number'))
      number.dataset.guess = Math.ceil(top(document.getElementById(number.dataset.of)) / page) + 1;
    all('[id^="picture-"]').forEach((picture, k) => {
      const place = document.getElementById(`above-${k}`);
      place.dataset.needs = (picture.getBoundingClientRect().bottom - top(place)) / MM;
      place.dataset.high = Math.max(...all('img', picture).map((it) => it.clientHeight)) / MM;
    });
    document.body.style.width = '';
  }
  const pictured = () => all('[id^="picture-"]').map(({ id }) => {
    const above = id.replace('picture', 'above'), place = document.getElementById(above),
        { needs, high } = place.dataset;
    return { id, above, needs: Number(needs), high: Number(high),
        chapter: place.closest('.chapter, .matter').id };
  });

  const anchors = () =>
      [...new Set(all('article a[href^="#"]').map((it) => it.getAttribute('href').slice(1)))];
  return { places, states, prepare, fill, anchors, pictured };
})();
