// On a telephone a figure is seen whole, with small letters, and at a tap in letters that can be
// read, to be scrolled.
addEventListener('load', () => {
  const LARGE = 576; // px, as in book.css
  for (const box of document.querySelectorAll('.figure-box')) {
    const image = box.querySelector('img'), words = image.alt.slice(0, 60);
    const button = Object.assign(document.createElement('button'),
        { type: 'button', className: 'figure-size', textContent: 'Larger' });
    const turn = () => {
      const large = box.classList.toggle('large');
      button.setAttribute('aria-pressed', large);
      // scrolled by the keyboard too
      for (const [name, value] of [['tabindex', 0], ['role', 'group'], ['aria-label', words]]) {
        large ? box.setAttribute(name, value) : box.removeAttribute(name);
      }
    };
    const look = () => {
      button.hidden = LARGE < 1.15 * box.clientWidth;
    };
    button.setAttribute('aria-pressed', false);
    button.setAttribute('aria-label', `Larger: ${words}`);
    button.addEventListener('click', turn);
    box.addEventListener('click', () => { if (button.offsetWidth) turn(); });
    box.after(button);
    addEventListener('resize', look);
    look();
  }
});
// The figures of the theme are loaded with the page, those of the other when it turns.
addEventListener('DOMContentLoaded', () => {
  const bring = () => {
    const theme = document.documentElement.dataset.theme === 'dark' ? 'dark' : 'light';
    for (const it of document.querySelectorAll(`img.only-${theme}`)) it.loading = 'eager';
  };
  new MutationObserver(bring)
      .observe(document.documentElement, { attributes: true, attributeFilter: ['data-theme'] });
  bring();
});
// Paper is white.
const theme = document.documentElement.dataset;
addEventListener('beforeprint', () => { theme.screen = theme.theme; theme.theme = 'light'; });
addEventListener('afterprint', () => { theme.theme = theme.screen; });
