// One switch unfolds the code of every chapter, and a symbol that is touched lights up wherever it
// stands.
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
