// On a telephone a figure is seen whole, with small letters, and at a tap in letters that can be read, to be scrolled.
addEventListener('DOMContentLoaded', () => {
  for (const box of document.querySelectorAll('.figure-box')) {
    const button = Object.assign(document.createElement('button'), { type: 'button', className: 'figure-size', textContent: 'Larger' });
    const turn = () => {
      const large = box.classList.toggle('large');
      button.setAttribute('aria-pressed', large);
      large ? box.setAttribute('tabindex', 0) : box.removeAttribute('tabindex'); // scrolled by the keyboard too
    };
    button.setAttribute('aria-pressed', false);
    button.addEventListener('click', turn);
    box.addEventListener('click', () => { if (button.checkVisibility()) turn(); });
    box.after(button);
  }
});
