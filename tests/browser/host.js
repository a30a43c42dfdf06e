// Stands in for the page's widget machinery: a model with traits, and a place for the view.

class Model {
  constructor(values) { this.values = values; this.callbacks = {}; }
  get(name) { return this.values[name]; }
  set(name, value) {
    if (JSON.stringify(this.values[name]) === JSON.stringify(value)) return;
    this.values[name] = value;
    for (const each of [...(this.callbacks[`change:${name}`] || [])]) each();
  }
  on(event, callback) { (this.callbacks[event] ||= []).push(callback); }
  off(event, callback) { this.callbacks[event] = (this.callbacks[event] || []).filter((each) => each !== callback); }
  save_changes() {}
}

async function mount(traits) {
  document.head.appendChild(document.createElement('style')).textContent = traits._css;
  const panel = window.panel = new Model(traits);
  const { default: widget } = await import(URL.createObjectURL(new Blob([traits._esm], { type: 'text/javascript' })));
  window.drawings = 0;
  const next = window.requestAnimationFrame.bind(window);
  window.requestAnimationFrame = (callback) => next((now) => { window.drawings += 1; callback(now); });
  window.unmount = widget.render({ model: panel, el: document.body.appendChild(document.createElement('div')) });
}
