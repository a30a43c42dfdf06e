// Finds the program of a panel: in the page, on the Jupyter server, or in the kernel. A notebook
// stores these lines alone of it, so that no change of a program changes a notebook.
const page = (globalThis.wmrPanels ||= {}); // programs by name
const programs = new WeakMap(); // or promises of them, by model

// Brings the style sheet, once.
function styled(href) {
  page.styled ||= new Promise((done) => {
    const link = Object.assign(document.createElement('link'), { rel: 'stylesheet', href });
    document.head.append(Object.assign(link, { onload: done, onerror: done }));
  });
  return page.styled;
}

// The modules as they lie beside each other on a server that says where, as the book's does.
async function served(kit, program) {
  await styled(new URL('panel.css', kit).href);
  return import(new URL(`${program}.js`, kit).href);
}

// Their texts, from the kernel.
function sent(model) {
  return new Promise((done) => {
    model.on('msg:custom', (texts) => done(texts));
    model.send('kit');
  });
}

// Each text as a module, after those that it imports.
async function made(texts, program) {
  const type = 'text/javascript', addresses = {};
  const blobOf = (text) => URL.createObjectURL(new Blob([text], { type }));
  const addressOf = (path) => (addresses[path] ||= blobOf(linked(path)));
  const linked = (path) => texts[path].replace(/(from|import) '(\.[^']+)'/g, (_, word, other) => {
    const { pathname } = new URL(other, `http://kit/${path}`);
    return `${word} '${addressOf(pathname.slice(1))}'`;
  });
  await styled(URL.createObjectURL(new Blob([texts['panel.css']], { type: 'text/css' })));
  return import(addressOf(`${program}.js`));
}

// Where a Jupyter server says that it has the kit; none, where it does not say so.
function kitAddress() {
  const told = document.getElementById('jupyter-config-data')?.textContent;
  const { baseUrl, wmrKit } = JSON.parse(told || '{}');
  return wmrKit && new URL(baseUrl + wmrKit, location.href);
}

async function find(model) {
  const program = model.get('program'), kit = kitAddress();
  if (!page[program]) {
    const module = await (kit ? served(kit, program) : made(await sent(model), program));
    page[program] = module.default;
  }
  return page[program];
}

function found(model) {
  if (!programs.has(model)) programs.set(model, find(model));
  return programs.get(model);
}

export default {
  // Without waiting: while a host waits for a model, it hears no answer of the kernel. What goes
  // wrong `render` says.
  initialize(context) {
    found(context.model).then((program) => program.initialize?.(context), () => {});
  },
  async render(context) {
    const { model, el } = context;
    // Stands there until the program comes, for ever where there is none: a page without a kernel.
    if (!kitAddress() && !page[model.get('program')])
      el.innerHTML = model.get('still') || 'Run this notebook to move what is here.';
    try {
      const program = await found(model);
      el.textContent = '';
      return program.render(context);
    } catch (error) {
      el.textContent = `This panel can't be loaded: ${error.message}. Run its cell again.`;
      throw error;
    }
  },
};
