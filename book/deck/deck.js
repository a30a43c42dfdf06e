// Starts a deck: draws the formulas, makes the words of each slide fit its window, lets what can
// move play when its slide is shown, and lets the panels have the keys that they need.
(() => {
  const root = document.documentElement, AUTO = 24000; // ms a slide, where the deck goes on alone
  root.dataset.theme = matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light';
  const pages = [...document.querySelectorAll('.page')], shown = new WeakSet();
  const rem = () => parseFloat(getComputedStyle(root).fontSize);

  /** Whether a part of a page, or a formula in it, needs more than its room. */
  const over = (it) => it.scrollHeight > it.clientHeight + 1 || it.scrollWidth > it.clientWidth + 1
      || [...it.querySelectorAll('mjx-container[display="true"]')].some((each) =>
        [each, ...each.querySelectorAll('svg')].some((part) =>
          part.getBoundingClientRect().width > each.parentElement.clientWidth + 1));

  /** Makes the words as large as fit; a panel's canvases take what is left. */
  function fit(page) {
    page.style.setProperty('--zoom', rem() / 15.1); // letters of 13 pixels are 24 at 1280 by 720
    const stage = page.querySelector('.wmr-stage'), figure = page.querySelector('figure');
    if (stage) {
      page.style.setProperty('--canvas', '0px');
      const left = figure.clientHeight - stage.parentElement.offsetHeight - 4;
      page.style.setProperty('--canvas', `${Math.max(180, left)}px`);
    }
    const live = page.querySelector('.live');
    const parts = [...page.querySelectorAll('.words, .body'), page, ...(live ? [live] : [])];
    const least = live ? 1 : 0.72; // 20 px
    for (let scale = live ? 1.25 : page.matches('.picture') ? 1 : 1.2; ; scale -= 0.03) {
      page.style.setProperty('--scale', Math.max(scale, least));
      // long texts beside a panel's pictures get more room, rather than smaller letters
      page.style.setProperty('--column', `${14 + 60 * Math.max(least - scale, 0)}rem`);
      if (scale <= least - (live ? 0.12 : 0) || !parts.some(over)) return;
    }
  }

  const inWidget = () => document.activeElement?.closest('.panel');
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
  const key = (code, letter, description, act) =>
      deck.addKeyBinding({ keyCode: code, key: letter, description }, act);
  key(68, 'D', 'Dark or light', () => {
    root.dataset.theme = root.dataset.theme === 'dark' ? 'light' : 'dark';
  });
  key(65, 'A', 'Go on alone, or stop', () => {
    const alone = !deck.getConfig().autoSlide;
    deck.configure({ autoSlide: alone ? AUTO : 0, loop: alone });
    if (alone) arrived();
  });
  addEventListener('keydown', (event) => {
    if (event.key === 'Escape' && inWidget()) {
      document.activeElement.blur();
      event.stopImmediatePropagation();
    }
  }, true);

  // After a click on an answer or a handle the arrows are the deck's again; a slider keeps them.
  addEventListener('pointerup', () => setTimeout(() => {
    if (inWidget() && document.activeElement.matches('button')) document.activeElement.blur();
  }));

  /** Draws the panels of a page. */
  async function show(page) {
    if (shown.has(page)) return;
    shown.add(page);
    const panels = [...page.querySelectorAll('.panel')];
    await Promise.all(panels.map((panel) => widgets.showAll(panel)));
    fit(page);
    for (const it of page.querySelectorAll('.panel > div, .live > *')) watch.observe(it);
  }

  // What plays: it begins anew on each visit, and stops when the slide is left.
  const press = (slide, words) =>
      [...slide.querySelectorAll('.live[data-open="true"] .live-play')]
      .filter((button) => button.textContent === words).at(-1)?.click();
  let left = null, waiting = 0;
  async function arrived() {
    const slide = deck.getCurrentSlide(), page = slide.querySelector('.page');
    document.activeElement?.blur();
    if (left && left !== slide) press(left, 'Stop');
    left = slide;
    clearTimeout(waiting);
    hold(deck.isOverview() ? null : slide);
    await show(page);
    fit(page);
    root.dataset.shown = deck.getIndices().h;
    if (matchMedia('(prefers-reduced-motion: reduce)').matches) return;
    waiting = setTimeout(() => {
      slide.querySelectorAll('.wmr.stage').forEach((it) => it.stage.play());
      if (!slide.querySelector('.live-play[aria-label^="Stop"]')) press(slide, 'Play');
      if (deck.getConfig().autoSlide)
        waiting = setTimeout(() => {
          slide.querySelector('.live[data-open="false"] .live-skip')?.click();
        }, AUTO / 3);
    }, 400);
  }

  /** Keeps Tab out of the slides that can't be seen. */
  function hold(slide) {
    for (const each of deck.getSlides()) each.inert = !printing && slide !== null && each !== slide;
  }

  // Panels change their size when they are used.
  const watch = new ResizeObserver((seen) => {
    for (const page of new Set(seen.map(({ target }) => target.closest('.page')))) fit(page);
  });
  // To print, reveal.js takes the slides out of the page for a moment and puts each on a sheet.
  // They are fitted before that, while they are slides; the panels come after it, for in that
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
    document.querySelectorAll('.page mjx-container:not([display])').forEach(tieFormula);
    deck.on('slidechanged', arrived);
    deck.on('overviewshown', () => hold(null));
    deck.on('overviewhidden', arrived);
    const fitAll = () => {
      pages.forEach(fit);
      deck.fitted = `${innerWidth} ${innerHeight}`;
    };
    addEventListener('resize', fitAll);
    fitAll();
    if (printing) { await printable; await Promise.all(pages.map(show)); } else await arrived();
    root.dataset.deck = 'ready';
  });
  deck.showAll = () => Promise.all(pages.map(show)); // for tests
  window.deck = deck;
})();
