// Settings of MathJax 3.
(function () {
  // What is wider than its box, a formula or an output, is scrolled by the keyboard too.
  const reach = () => document.querySelectorAll('mjx-container[display], .cell_output pre')
      .forEach((it) => {
    it.scrollWidth > it.clientWidth ? it.setAttribute('tabindex', 0)
        : it.removeAttribute('tabindex');
  });
  // One in a sentence scrolls only if it has to: what scrolls is a stop of the keyboard.
  const widen = () =>
      document.querySelectorAll('span.math mjx-container')
      .forEach((it) =>
      it.classList.toggle('wide',
      it.firstElementChild.getBoundingClientRect().width > it.clientWidth + 1));
  window.addEventListener('resize', () => { widen(); reach(); });
  /** Keeps the bracket before a formula and the mark behind it on its line. */
  window.tieFormula = (formula) => {
    const { previousSibling: before, nextSibling: after } = formula;
    const part = (node, shape) => (node?.nodeType === Node.TEXT_NODE && node.data.match(shape)?.[0])
        || '';
    const bracket = part(before, /[([“‘]+$/), mark = part(after, /^[.,:;?!)\]”’]+/);
    if (!bracket && !mark) return;
    const line = document.createElement('span');
    line.className = 'tied';
    formula.replaceWith(line);
    if (bracket) before.data = before.data.slice(0, -bracket.length);
    if (mark) after.data = after.data.slice(mark.length);
    line.append(bracket, formula, mark);
  };
  window.MathJax = {
    tex: { inlineMath: [['\\(', '\\)'], ['$', '$']] },
    // Centred, a formula would need as much room on its left as its number has on its right.
    svg: { displayAlign: 'left',
        displayIndent: window.innerWidth > 600 && !document.querySelector('.reveal') ? '1em'
        : '0' },
    options: {
      enableMenu: false,  // it would load more files when it is opened
      ignoreHtmlClass: 'tex2jax_ignore|mathjax_ignore|document',
      processHtmlClass: 'tex2jax_process|mathjax_process|math|output',
    },
    startup: {
      ready() {
        MathJax.startup.defaultReady();
        MathJax.startup.promise.then(() => {
          document.querySelectorAll('span.math').forEach(tieFormula);
          widen();
          reach();
        });
      },
    },
  };
})();
