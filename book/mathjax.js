// Settings of MathJax 3. The widgets still speak to MathJax 2: they ask MathJax.Hub.Queue to typeset their labels, possibly before
// MathJax has started.
(function () {
  let start;
  const started = new Promise((resolve) => { start = resolve; });
  const Hub = { Queue: ([, , element]) => started.then(() => MathJax.typesetPromise([element])) };
  // A formula that is wider than its box is scrolled by the keyboard too.
  const reach = () => document.querySelectorAll('mjx-container[display]').forEach((it) => {
    it.scrollWidth > it.clientWidth ? it.setAttribute('tabindex', 0) : it.removeAttribute('tabindex');
  });
  window.addEventListener('resize', reach);
  window.MathJax = {
    Hub,
    tex: { inlineMath: [['\\(', '\\)'], ['$', '$']] },  // widget labels are written with dollars
    options: {
      enableMenu: false,  // it would load more files when it is opened
      ignoreHtmlClass: 'tex2jax_ignore|mathjax_ignore|document',
      processHtmlClass: 'tex2jax_process|mathjax_process|math|output|widget-html|widget-htmlmath|widget-label',
    },
    startup: {
      ready() {
        MathJax.startup.defaultReady();
        MathJax.Hub = Hub;
        MathJax.startup.promise.then(start).then(reach);
      },
    },
  };
})();
