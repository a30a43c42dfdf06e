// Starts a deck: draws the formulas, makes each slide fit its window, and lets the widgets have the
// keys that they need.
(() => {
  const pages = [...document.querySelectorAll('.page')];
  // so that it scrolls by keyboard
  for (const table of document.querySelectorAll('.output_markdown')) table.tabIndex = 0;
  pages.forEach(arrange);

  /** Puts a slide's figure or panel beside its words, all of its code behind one button, and its
   * notes together. */
  function arrange(page) {
    page.querySelectorAll('.fragment').forEach((it, count) => {
      it.dataset.fragmentIndex = count;
    });
    // reveal.js would show only those of the fragment that came last
    const notes = [...page.querySelectorAll('aside.notes')];
    const [fold, ...folds] = page.querySelectorAll('details.code');
    for (const other of folds) {
      fold.querySelector('.lines').append(...other.querySelectorAll('.highlight'));
      other.remove();
    }
    fold?.remove();  // it stands below, and what held nothing else goes
    const [title, ...rest] = page.children;
    const body = box('body'), words = body.appendChild(box('words')),
        picture = page.querySelector('.output img, .panel');
    words.append(...rest);
    if (picture) {
      const figure = body.appendChild(document.createElement('figure')),
          caption = words.querySelector('.caption');
      const step = picture.closest('.fragment');
      if (step && !step.querySelector('pre, p:not(.caption *)')) {
        figure.className = 'fragment';
        figure.dataset.fragmentIndex = step.dataset.fragmentIndex;
      }
      figure.append(picture, ...(caption ? [caption] : []));
    }
    title.className = 'title';
    for (const it of [...words.querySelectorAll('.cell, .fragment')].reverse())
      if (!it.textContent.trim() && !it.querySelector('svg, table')) it.remove();
    words.hidden = !words.textContent.trim() && !words.querySelector('svg, table');
    page.replaceChildren(title, body, ...notes, ...(fold ? [fold] : []));
  }

  function box(name) {
    const made = document.createElement('div');
    made.className = name;
    return made;
  }

  const set = (page, name, value) =>
      (value === null ? page.style.removeProperty(name) : page.style.setProperty(name, value));

  /** What a page holds, as a multiple of the place for it: more than 1 overflows. */
  const excess = (page) =>
      Math.max(
      ...[page,
      ...page.querySelectorAll('.body, .words')].flatMap((it) =>
      [(it.scrollHeight - 1) / it.clientHeight, (it.scrollWidth - 1) / it.clientWidth]));

  // what the last row can read
  const smallest = () => Math.min(innerHeight, innerWidth * 9 / 16) / 40;
  // A figure stands beside the words, which have this share of the width, or below them.
  const PLACES = [0.36, 0.46, 0.56, 'below'];

  /** Makes the words of a slide as large as fit, and its figure; a panel's picture takes what
   * its sliders leave. */
  function fit(page) {
    const image = page.querySelector('figure img');
    if (page.querySelector('.panel')) {
      set(page, '--zoom', rem() / 22);  // letters of 13 pixels grow as those of the words do
      set(page, '--canvas', '0px');
      const figure = page.querySelector('figure');
      set(page, '--canvas',
          `${Math.max(180, figure.clientHeight - figure.firstElementChild.offsetHeight - 4)}px`);
    } else if (!image) {
      scaled(page, 1.3);
    } else {
      const places = page.querySelector('.words[hidden]') ? ['below'] : PLACES;
      const seen = places.map((where) => place(page, image, where));
      const best = places[seen.indexOf(Math.max(...seen))];
      if (best !== places.at(-1)) place(page, image, best);
    }
  }

  /** Lays a figure out in one of the places, and says how well one sees it. */
  function place(page, image, where) {
    page.classList.toggle('below', where === 'below');
    set(page, '--share', where === 'below' ? 1 : where);
    image.style.height = image.style.width = '0';
    const scale = scaled(page, 1.1);
    const figure = image.parentElement,
        caption = figure.querySelector('.caption')?.offsetHeight ?? 0;
    const height = Math.max(0,
        Math.min(figure.clientHeight - caption,
        figure.clientWidth * image.naturalHeight / image.naturalWidth));
    image.style.height = `${height}px`;
    image.style.width = `${height * image.naturalWidth / image.naturalHeight}px`;
    return scale * height;
  }

  /** Sets the largest scale of the words at which all can be seen, and returns it: next to
   * nothing if not all of them can be read then. */
  function scaled(page, largest) {
    const formulas =
        [...page.querySelectorAll(
        '.words mjx-container[display="true"], .output_latex mjx-container')],
        texts = [...page.querySelectorAll('.output pre')];
    const wide = [...formulas, ...texts];
    for (let scale = largest; ; ) {
      set(page, '--scale', scale);
      for (const it of wide) it.style.fontSize = it.style.whiteSpace = '';
      const sizes = wide.map((it) => [it, parseFloat(getComputedStyle(it).fontSize), widest(it)]);
      for (const it of sizes) {
        if (it[2] <= 1) continue;
        it[1] /= it[2] + 0.02;
        if (it[0].tagName === 'PRE' && it[1] < smallest()) {  // rather on two lines
          it[1] = smallest() + 0.1;
          it[0].style.whiteSpace = 'pre-wrap';
        }
        it[0].style.fontSize = `${it[1]}px`;
      }
      const over = excess(page);
      if (over <= 1)
        return Math.min(scale * rem(), ...sizes.map((it) => it[1])) < smallest() ? scale / 100
            : scale;
      if (scale <= 0.65) return scale / 1000;
      scale = Math.max(0.65, Math.min(scale - 0.03, scale / Math.sqrt(over)));
    }
  }

  const rem = () => parseFloat(getComputedStyle(document.documentElement).fontSize);
  /** A formula's or a print's width, as a multiple of the place for it. */
  const widest = (it) =>
      (it.tagName === 'PRE' ? it.scrollWidth / it.clientWidth
      : Math.max(
      ...[it, ...it.querySelectorAll('svg')].map((part) => part.getBoundingClientRect().width))
      / it.parentElement.clientWidth);

  const inWidget = () => document.activeElement?.closest('.panel, .output_markdown');
  const deck = new Reveal(document.querySelector('.reveal'), {
    plugins: [RevealNotes],
    disableLayout: true,
    viewDistance: 1e6,  // all slides are laid out from the start, so that all can be measured
    mobileViewDistance: 1e6,
    navigationMode: 'linear',
    transition: 'none',
    hash: true,
    slideNumber: 'c/t',
    controls: false,
    pdfSeparateFragments: false,
    // In a panel the arrows are the slider's; a presenter's remote control sends PageUp and
    // PageDown, which go on.
    keyboardCondition: (event) => !inWidget() || ['PageUp', 'PageDown'].includes(event.key),
  });
  addEventListener('keydown', (event) => {
    if (event.key === 'Escape' && inWidget()) {
      document.activeElement.blur();
      event.stopImmediatePropagation();
    }
    if (event.key === 'c' && !inWidget() && !event.ctrlKey && !event.metaKey) {
      for (const fold of deck.getCurrentSlide().querySelectorAll('details.code'))
        fold.open = !fold.open;
    }
  }, true);

  function arrived() {
    const slide = deck.getCurrentSlide();
    for (const fold of document.querySelectorAll('details.code[open]')) fold.open = false;
    document.activeElement?.blur();
    fit(slide.querySelector('.page'));
    hold(deck.isOverview() ? null : slide);
  }

  /** Keeps Tab out of the slides that can't be seen. */
  function hold(slide) {
    for (const each of deck.getSlides()) each.inert = !printing && slide !== null && each !== slide;
  }

  // To print, reveal.js takes the slides out of the page for a moment and puts each on a sheet.
  // They are fitted before that, while they are slides; the widgets come after it, for in that
  // moment they would find no place.
  const printing = deck.isPrintingPDF();
  const printable = new Promise((resolve) => deck.on('pdf-ready', resolve));
  const drawn =
      Promise.all(
      [MathJax.startup.promise,
      ...[...document.images].map((image) => image.decode().catch(() => {}))]);
  const started = printing ? drawn.then(() => deck.initialize()) : deck.initialize();

  Promise.all([started, drawn]).then(async () => {
    // The speaker's window has not the style that hides a formula's second copy, which is for
    // screen readers.
    for (const copy of document.querySelectorAll('aside.notes mjx-assistive-mml')) copy.remove();
    document.querySelectorAll('.words mjx-container:not([display])').forEach(tieFormula);
    deck.on('slidechanged', arrived);
    deck.on('overviewshown', () => hold(null));
    deck.on('overviewhidden', arrived);
    const fitAll = () => {
      pages.forEach(fit);
      deck.fitted = `${innerWidth} ${innerHeight}`;
    };
    addEventListener('resize', fitAll);
    // Widgets come when they come, and change their size when they are used.
    const watch = new ResizeObserver(() =>
        pages.filter((page) => page.querySelector('.panel')).forEach(fit));
    document.querySelectorAll('.panel').forEach((panel) => watch.observe(panel));
    fitAll();
    arrived();
    if (printing) await printable;
    widgets.showAll();
    document.documentElement.dataset.deck = 'ready';
  });
  window.deck = deck;
})();
