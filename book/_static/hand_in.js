// Below a page's graded tasks: a button that saves their notebook, as students are given it, with
// the page's answers. It is graded as any other.
(function () {
  const NAME = 'wmr-user-name';

  const make = (tag, properties = {}, ...children) => {
    const element = Object.assign(document.createElement(tag), properties);
    element.append(...children);
    return element;
  };

  const cellsOf = () => [...document.querySelectorAll('script.python-cell')].map((script) => {
    const cell = JSON.parse(script.textContent);
    return { ...cell,
        written: script.closest('.cell').querySelector('.python-editor')?.value ?? cell.source };
  });

  const idOf = (cell) => cell.metadata.nbgrader.grade_id;

  // The name that the page's own cell makes a student's numbers of.
  const nameInPage = () =>
      /^name = (["'])(.*?)\1/m.exec(cellsOf().find((it) => it.name === 'mine')?.written)?.[2].trim()
      ?? '';

  function answered(notebook, who) {
    const made = structuredClone(notebook),
        tasks = cellsOf().filter((it) => it.space === 'tasks'),
        answers = new Map(tasks.map((it) => [it.name, it]));
    for (const cell of made.cells) {
      const answer = answers.get(idOf(cell));
      if (answer && idOf(cell) !== 'mine' && answer.written !== answer.source)
        cell.source = answer.written;
      else if (idOf(cell) === 'name') cell.source = `name = ${JSON.stringify(who)}`;
    }
    return made;
  }

  function save(name, text) {
    const link = make('a',
        { href: URL.createObjectURL(new Blob([text], { type: 'application/x-ipynb+json' })),
        download: name });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
  }

  // Some browsers keep nothing for files.
  const kept = () => { try { return localStorage.getItem(NAME) ?? ''; } catch { return ''; } };
  const keep = (name) => { try { localStorage.setItem(NAME, name); } catch { /* it may not */ } };

  function enliven(script) {
    const { file, notebook, elsewhere } = JSON.parse(script.textContent),
        named = notebook.cells.some((it) => idOf(it) === 'name');
    const who = make('input',
        { value: kept(), autocomplete: 'off', maxLength: 60, oninput: () => keep(who.value) });
    const status = make('span', { className: 'python-status' });
    status.setAttribute('role', 'status');
    const refused = (sentence) => { status.textContent = sentence; who.focus(); };
    const onclick = () => {
      const there = nameInPage(), name = who.value.trim() || there;
      if (named && !name)
        return refused('Your user name is missing: numbers of your own are made of it.');
      if (named && there && there.toLowerCase() !== name.toLowerCase())
        return refused(
            `The cell above says name = "${there}": its numbers are not those of ${name}.`);
      save(file, JSON.stringify(answered(notebook, name), null, 1));
      status.textContent = `${file} is in your downloads. Hand it in under this name.`;
    };
    const about = elsewhere.length
        ? `It has this page's answers. Still to be answered in it, in JupyterLab: ` +
        `${elsewhere.join('; ')}.` : "It has this page's answers.";
    script.after(make('div', { className: 'python-tools python-hand-in' },
      ...(named ? [make('label', {}, 'User name, as your lecturer writes it: ', who)] : []),
      make('button', { type: 'button', textContent: 'Save the notebook to hand in', onclick }),
          status, make('span', { textContent: about })));
  }

  document.addEventListener('DOMContentLoaded',
      () => document.querySelectorAll('script.python-hand-in').forEach(enliven));
})();
