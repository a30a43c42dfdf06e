// Loaded before require.js, which takes these as its settings: where this book keeps the widgets, their icon fonts and anywidget.
(function () {
  const vendor = new URL('vendor', document.currentScript.src).href;
  window.require = {
    paths: {
      '@jupyter-widgets': `${vendor}/widgets`,
      '@jupyter-widgets/html-manager/dist': `${vendor}/widgets`,
      anywidget: `${vendor}/anywidget/index`,
    },
  };
})();
