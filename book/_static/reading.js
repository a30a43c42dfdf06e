// One switch unfolds the code of every chapter, a symbol that is touched lights up wherever it
// stands, each copy button says what it copies, and a page that is opened again, by Back or anew,
// is where one read.
addEventListener('DOMContentLoaded', () => {
  const KEY = 'wmr-code', root = document.documentElement;
  const kept = () => { try { return localStorage.getItem(KEY); } catch { return null; } };
  const keep = (value) => { try { localStorage.setItem(KEY, value); } catch { /* it may not */ } };
  const folds = [...document.querySelectorAll('details.above-input')];
  const place = document.querySelector('.run-it');
  if (folds.length && place) {
    const button = Object.assign(document.createElement('button'),
        { type: 'button', className: 'all-code', textContent: 'Show all code' });
    let shown = false;
    const turn = (open) => {
      shown = open;
      button.textContent = open ? 'Fold all code' : 'Show all code';
      for (const fold of folds) fold.open = open;
    };
    button.addEventListener('click', () => {
      turn(!shown);
      keep(shown ? 'shown' : 'folded');
    });
    place.append(' ', button);
    if (kept() === 'shown') turn(true); // an answer's cell is open anyhow
  }

  const nameButton = (button) => {
    const block = document.querySelector(button.dataset.clipboardTarget);
    const [line] = block.textContent.trim().split('\n');
    const kind = button.closest('.cell_output') ? 'output' : 'code';
    const { tooltip } = button.dataset; // what came of it, for a moment
    button.setAttribute('aria-label',
        tooltip === 'Copy' ? `Copy the ${kind}: ${line.slice(0, 60)}` : tooltip);
  };
  const article = document.querySelector('.bd-article');
  article?.querySelectorAll('.copybtn').forEach(nameButton);
  if (article) { // or they come later, when their own script has been loaded
    const options = { attributeFilter: ['data-tooltip'], childList: true, subtree: true };
    new MutationObserver((changes) => {
      for (const { target, addedNodes } of changes)
        for (const it of [target, ...addedNodes])
          if (it instanceof Element && it.matches('.copybtn')) nameButton(it);
    }).observe(article, options);
  }

  // The browser remembers how far down one was; but what stands above is higher once its panels
  // are drawn. So the part of the text at the window's head is remembered.
  const parts = [...article?.querySelectorAll('section > :not(section)') || []];
  const entry = () => history.state || {};
  const go = () => {
    const { part, top } = entry();
    if (parts[part]) scrollBy({ top: parts[part].getBoundingClientRect().top - top,
      behavior: 'instant' });
  };
  let waits = parts.length && 'part' in entry(); // until a hand moves the page
  const settling = new ResizeObserver(() => { if (waits) go(); });
  if (waits) settling.observe(article);
  for (const event of ['wheel', 'touchstart', 'pointerdown', 'keydown'])
    addEventListener(event, () => { waits = false; settling.disconnect(); }, { passive: true });
  addEventListener('popstate', go); // Back within a page
  addEventListener('scrollend', () => {
    if (waits) return;
    const boxes = parts.map((it) => it.getBoundingClientRect()),
        part = boxes.findIndex(({ bottom, height }) => height && bottom > 0);
    if (part < 0) return;
    history.scrollRestoration = 'manual';
    history.replaceState({ ...entry(), part, top: boxes[part].top }, '');
  });
  addEventListener('keydown', ({ key }) => {
    if (key === 'Escape')
      document.querySelector('[data-bs-toggle="dropdown"][aria-expanded="true"]')?.click();
  });

  const roleOf = (target) => {
    const it = target instanceof Element && target.closest('[data-c], .live-symbol');
    return it && (it.dataset.role || getComputedStyle(it).getPropertyValue('--role').trim());
  };
  const light = ({ target }) => {
    const role = roleOf(target);
    if (role) root.dataset.lit = role; else delete root.dataset.lit;
  };
  for (const event of ['pointerover', 'pointerdown']) addEventListener(event, light);
});
