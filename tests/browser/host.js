// Shows one widget as the book's pages do, and counts its drawings.

async function mount(traits, texts) {
  window.drawings = 0;
  const next = window.requestAnimationFrame.bind(window);
  window.requestAnimationFrame = (callback) => next((now) => {
    window.drawings += 1;
    callback(now);
  });
  window.panel = widgets.modelOf(traits);
  const { on } = panel;
  // as a kernel answers
  panel.on = (event, listener) => (event === 'msg:custom' ? listener(texts) : on(event, listener));
  window.unmount =
      await widgets.show(document.body.appendChild(document.createElement('div')), panel);
}
