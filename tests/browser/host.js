// Stands in for the page's widget machinery: a model with traits, the links of an Explorer, and plain inputs for its sliders and menus.

class Model {
  constructor(values) { this.values = values; this.callbacks = {}; }
  get(name) { return this.values[name]; }
  set(name, value) {
    if (Object.is(this.values[name], value)) return;
    this.values[name] = value;
    for (const event of [`change:${name}`, 'change']) for (const each of [...(this.callbacks[event] || [])]) each();
  }
  on(event, callback) { (this.callbacks[event] ||= []).push(callback); }
  off(event, callback) { this.callbacks[event] = (this.callbacks[event] || []).filter((each) => each !== callback); }
  save_changes() {}
}

function control({ name, text, kind, value, options, low, high, log }, panel, place) {
  const label = place.appendChild(document.createElement('label')), input = label.appendChild(document.createElement(options ? 'select' : 'input'));
  label.prepend(text);
  label.style.display = 'flex';
  input.dataset.control = name;
  if (options) options.forEach((each, i) => input.add(new Option(each, i)));
  else Object.assign(input, { type: 'range', step: 'any', min: low, max: high });
  const show = (value) => { input.value = log ? Math.log10(value) : value; };
  show(value);
  input.addEventListener('input', () => panel.set(name, log ? 10 ** input.value : Number(input.value)));
  panel.on(`change:${name}`, () => show(panel.get(name)));
  return label;
}

async function mount({ traits, controls, module, css }) {
  document.head.appendChild(document.createElement('style')).textContent = css;
  const card = document.body.appendChild(document.createElement('div')), place = card.appendChild(document.createElement('div'));
  card.className = 'wmr-explorer';
  place.className = 'wmr-controls';
  const panel = window.panel = new Model(traits);
  for (const each of controls) {
    const label = control(each, panel, place);
    if (!each.display) continue;
    const show = () => { label.style.display = panel.get(each.display); };
    panel.on(`change:${each.display}`, show);
    show();
  }
  const { default: widget } = await import(URL.createObjectURL(new Blob([module], { type: 'text/javascript' })));
  window.drawings = 0;
  const next = window.requestAnimationFrame.bind(window);
  window.requestAnimationFrame = (callback) => next((now) => { window.drawings += 1; callback(now); });
  window.unmount = widget.render({ model: panel, el: card.appendChild(document.createElement('div')) });
}
