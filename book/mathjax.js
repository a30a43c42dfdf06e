// Settings of MathJax 3.
(function () {
  // What is wider than its box, a formula or an output, is scrolled by the keyboard too.
  const reach = () => document.querySelectorAll('mjx-container[display], .cell_output pre').forEach((it) => {
    it.scrollWidth > it.clientWidth ? it.setAttribute('tabindex', 0) : it.removeAttribute('tabindex');
  });
  window.addEventListener('resize', reach);
  window.MathJax = {
    tex: { inlineMath: [['\\(', '\\)'], ['$', '$']] },
    // Centred, a formula would need as much room on its left as its number has on its right.
    svg: document.querySelector('.reveal') ? {}
      : { displayAlign: 'left', displayIndent: window.innerWidth > 600 ? '1em' : '0' },
    options: {
      enableMenu: false,  // it would load more files when it is opened
      ignoreHtmlClass: 'tex2jax_ignore|mathjax_ignore|document',
      processHtmlClass: 'tex2jax_process|mathjax_process|math|output',
    },
    startup: {
      ready() {
        MathJax.startup.defaultReady();
        MathJax.startup.promise.then(reach);
      },
    },
  };
})();
