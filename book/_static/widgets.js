// Brings the widgets of a page or a deck to life without a kernel. Each is an anywidget: an ES
// module that finds its program in the page, and the values that they share, as notebooks store
// them.
(function () {
  const TYPE = 'application/vnd.jupyter.widget';
  const once = (make) => { // for what many widgets have in common
    const made = new Map();
    return (text) => made.has(text) ? made.get(text) : made.set(text, make(text)).get(text);
  };
  const imported = once(async (text) => {
    const address = URL.createObjectURL(new Blob([text], { type: 'text/javascript' }));
    try { return (await import(address)).default; } finally { URL.revokeObjectURL(address); }
  });

  // What a widget sees of itself, as under Backbone: whoever listens hears of a value only if it is
  // another one.
  function modelOf(values) {
    const listeners = {}, heard = (event) => listeners[event] ||= new Set();
    return {
      get: (name) => values[name],
      set(name, value) {
        const same = JSON.stringify(value) === JSON.stringify(values[name]);
        values[name] = value;
        if (!same) for (const listener of [...heard(`change:${name}`)]) listener();
      },
      save_changes() {}, // there is no kernel to tell,
      send() {}, // nor to ask
      on: (event, listener) => heard(event).add(listener),
      off: (event, listener) => heard(event).delete(listener),
    };
  }

  async function show(place, model) {
    const el = document.createElement('div');
    place.after(el);
    try {
      return await (await imported(model.get('_esm'))).render({ model, el });
    } catch (error) {
      el.className = 'widget-error';
      el.textContent = `This can't be shown here: ${error.message}`;
      throw error;
    } finally {
      el.classList.add('jupyter-widgets'); // it is there
    }
  }

  // Shows the widgets that are below `root`, with the states that stand there too.
  function showAll(root = document) {
    const parts = (kind) => [...root.querySelectorAll(`script[type="${TYPE}-${kind}+json"]`)];
    const states = Object.assign({}, ...parts('state').map((it) => JSON.parse(it.text).state));
    // one that is shown twice moves in both places
    const models = once((id) => modelOf(states[id].state));
    // on paper stand pictures
    const shown = parts('view').map((place) => [place, JSON.parse(place.text).model_id])
        .filter(([, id]) => id in states);
    return Promise.all(shown.map(([place, id]) => show(place, models(id))));
  }
  window.widgets = { modelOf, show, showAll };
  // In a deck, on paper and in tests somebody else says when.
  if (document.currentScript.dataset.start) addEventListener('DOMContentLoaded', () => showAll());
})();
