// Starts a deck: draws the formulas, makes each slide fit its window, and lets the widgets have the keys that they need.
(() => {
  const pages = [...document.querySelectorAll('.page')];
  // Notes of a slide stand together: reveal.js would show only those of the fragment that came last.
  for (const page of pages) page.append(...page.querySelectorAll('aside.notes'));
  for (const table of document.querySelectorAll('.output_markdown')) table.tabIndex = 0;  // so that it scrolls by keyboard
  for (const fold of document.querySelectorAll('details.code')) {
    fold.addEventListener('toggle', () => {
      const { top } = fold.getBoundingClientRect();
      fold.classList.toggle('upwards', top > innerHeight / 2);
    });
  }

  const set = (page, name, value) => (value === null ? page.style.removeProperty(name) : page.style.setProperty(name, value));

  /** Whether something of a page lies outside its margins. */
  function overflows(page) {
    const box = page.getBoundingClientRect(), style = getComputedStyle(page);
    const low = box.bottom - parseFloat(style.paddingBottom) + 1;
    return [...page.children].some((it) => it.getBoundingClientRect().bottom > low) || page.scrollHeight > page.clientHeight + 1 || page.scrollWidth > page.clientWidth + 1;
  }

  /** Makes figures and then text smaller until all of a page can be seen; a panel's picture takes what its sliders leave. */
  function fit(page) {
    for (const name of ['--scale', '--figure', '--canvas', '--table']) set(page, name, null);
    for (const formula of page.querySelectorAll('mjx-container[display="true"]')) narrow(formula);
    for (const text of page.querySelectorAll('.output pre')) narrowText(text);
    if (page.querySelector('.panel canvas')) {
      for (let height = innerHeight; height > 180 && (height === innerHeight || overflows(page)); height -= 10) set(page, '--canvas', `${height}px`);
      return;
    }
    if (page.querySelector('.output img')) {
      for (let height = 20; overflows(page) && height >= 11; height -= 0.5) set(page, '--figure', `${height}em`);
    }
    if (page.querySelector('.output_markdown')) {
      for (let height = 23; overflows(page) && height >= 12; height -= 0.5) set(page, '--table', `${height}rem`);
    }
    for (let scale = 0.97; overflows(page) && scale >= 0.6; scale -= 0.03) set(page, '--scale', scale.toFixed(2));
  }

  function narrow(formula) {
    const widest = () => Math.max(...[...formula.querySelectorAll('svg')].map((it) => it.getBoundingClientRect().width));
    formula.style.fontSize = '';
    for (let size = 98; widest() > formula.parentElement.clientWidth + 0.5 && size >= 46; size -= 2) formula.style.fontSize = `${size}%`;
  }

  function narrowText(text) {
    text.style.fontSize = text.style.whiteSpace = '';
    for (let size = 0.8; text.scrollWidth > text.clientWidth && size >= 0.6; size -= 0.02) text.style.fontSize = `${size}em`;
    if (text.scrollWidth > text.clientWidth) text.style.whiteSpace = 'pre-wrap';
  }

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
    // In a panel the arrows are the slider's; a presenter's remote control sends PageUp and PageDown, which go on.
    keyboardCondition: (event) => !inWidget() || ['PageUp', 'PageDown'].includes(event.key),
  });
  addEventListener('keydown', (event) => {
    if (event.key === 'Escape' && inWidget()) {
      document.activeElement.blur();
      event.stopImmediatePropagation();
    }
    if (event.key === 'c' && !inWidget() && !event.ctrlKey && !event.metaKey) {
      for (const fold of deck.getCurrentSlide().querySelectorAll('details.code')) fold.open = !fold.open;
    }
  }, true);

  const where = document.querySelector('.where'), title = document.title;
  function arrived() {
    const slide = deck.getCurrentSlide();
    const heading = slide.closest('.slides > section').querySelector('h2');
    where.textContent = heading ? `${title}: ${heading.textContent.replace('¶', '')}` : title;
    for (const fold of document.querySelectorAll('details.code[open]')) fold.open = false;
    document.activeElement?.blur();
    fit(slide.querySelector('.page'));
  }

  // To print, reveal.js takes the slides out of the page for a moment and puts each on a sheet. They are fitted before that, while they
  // are slides; the widgets come after it, for in that moment they would find no place.
  const printing = deck.isPrintingPDF();
  const printable = new Promise((resolve) => deck.on('pdf-ready', resolve));
  const drawn = Promise.all([MathJax.startup.promise, ...[...document.images].map((image) => image.decode().catch(() => {}))]);
  const started = printing ? drawn.then(() => deck.initialize()) : deck.initialize();

  function startWidgets() {
    const waiting = document.querySelector('script[type="text/widgets"]');
    if (!waiting) return;
    const script = document.createElement('script');
    for (const { name, value } of waiting.attributes) if (name !== 'type') script.setAttribute(name, value);
    waiting.replaceWith(script);
  }

  Promise.all([started, drawn]).then(async () => {
    // The speaker's window has not the style that hides a formula's second copy, which is for screen readers.
    for (const copy of document.querySelectorAll('aside.notes mjx-assistive-mml')) copy.remove();
    deck.on('slidechanged', arrived);
    addEventListener('resize', () => pages.forEach(fit));
    // Widgets come when they come, and change their size when they are used.
    const watch = new ResizeObserver(() => pages.filter((page) => page.querySelector('.panel')).forEach(fit));
    document.querySelectorAll('.panel').forEach((panel) => watch.observe(panel));
    pages.forEach(fit);
    arrived();
    if (printing) await printable;
    startWidgets();
    document.documentElement.dataset.deck = 'ready';
  });
  window.deck = deck;
})();
