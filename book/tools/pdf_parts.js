// What the panels of the site become on paper, and the folded parts of a page: see pdf.js.
window.parts = (() => {
  const begins = () => [...document.querySelectorAll('span[id^="document-"]')];
  const all = (selector, root = document) => [...root.querySelectorAll(selector)];
  const title = (section) => section.querySelector(':scope > :is(h1, h2, h3, h4, h5)');
  const views = () => all('script[type="application/vnd.jupyter.widget-view+json"]');
  const nameOf = (begin) => begin.id.replace('document-', '');
  const wordsOf = (it) => {
    const copy = it.cloneNode(true);
    all('.headerlink, .number', copy).forEach((each) => each.remove());
    return copy.textContent.trim();
  };
  function made(tag, className, html = '') {
    const it = document.createElement(tag);
    it.className = className;
    it.innerHTML = html;
    return it;
  }

  // The document that each panel is in, such as notebooks/04_lyapunov; the front page has no mark.
  const places = () => views().map((panel) => {
    const before = (it) => it.compareDocumentPosition(panel) & Node.DOCUMENT_POSITION_FOLLOWING;
    const last = begins().filter(before).at(-1);
    return last ? nameOf(last) : 'index';
  });

  // ---- pictures of the panels, on the page that shows them -------------------------------------
  // Words with symbols; numbers and choices among them are text.
  function wordsOn(it) {
    const said = it.cloneNode(true), there = all('input, select', it);
    all('input, select', said).forEach((knob, k) => knob.replaceWith(
        there[k].selectedOptions ? there[k].selectedOptions[0].text : there[k].value));
    all('*', said).forEach((part) => {
      if (part.tagName === 'I') part.className = 'symbol';
      else if (part.tagName !== 'SUB') part.replaceWith(...part.childNodes);
    });
    return said.innerHTML;
  }
  const settled = () => new Promise((done) => setTimeout(done, 60));
  const shots = (panel) => all('canvas', panel).filter((it) => it.checkVisibility()
      && it.hasAttribute('aria-label')).map((it) =>
    [it.toDataURL(), it.getAttribute('aria-label')]);
  const knobs = (panel) => all('.wmr-control, .my-row', panel).map((row) => {
    const knob = row.querySelector('select, .wmr-typed, input:not([type=range])');
    return knob && [wordsOf(row.querySelector('span') || row),
      knob.selectedOptions ? knob.selectedOptions[0]?.text : knob.value].join(' ');
  }).filter(Boolean);

  // What a panel shows before a prediction and after it: there is no control on paper.
  async function states() {
    const found = [];
    for (const panel of all('.jupyter-widgets')) {
      while (panel.querySelector('.my-robot[data-done=false]')) await settled();
      const gate = panel.querySelector('.live-gate'), state = { given: shots(panel) };
      if (gate) {
        state.question = wordsOn(gate.querySelector('.live-question'));
        state.options = all('.live-options label > span', gate).map(wordsOn);
        all('button', gate).find((it) => it.textContent === 'Just show me').click();
        do await settled(); while (!panel.querySelector('.live[data-open=true]'));
        const keys = all('.live-options label', gate).map((it) => it.matches('.live-key'));
        state.key = keys.indexOf(true);
        state.why = wordsOn(gate.querySelector('.live-verdict'));
        state.asked = shots(panel);
      }
      const says = panel.querySelector('.live-sentence, .wmr-status, .front-words');
      if (says) state.says = wordsOn(says);
      if (panel.querySelector('.wmr-stage, .my-robot')) state.knobs = knobs(panel);
      state.table = panel.querySelector('.my-results dl')
          && all('.my-results dl', panel).map((it) => it.outerHTML).join('');
      found.push(state);
    }
    return found;
  }

  // ---- the book ---------------------------------------------------------------------------------
  const letter = (k) => `(${String.fromCharCode(97 + k)})`;
  function pictures(shown, words) {
    const kind = shown.length === 1 ? 'alone' : 'pair';
    const figure = made('figure', kind, '<div class="panes"></div>');
    for (const [src, alt] of shown)
      figure.firstChild.append(Object.assign(new Image(), { src, alt }));
    if (words) figure.append(made('figcaption', '', words));
    return figure;
  }

  // A panel becomes a picture of its state; a prediction a question, whose answer stands at the
  // back.
  function still(states) {
    const answers = made('section', 'matter', '<h3>Answers to the predictions</h3>');
    answers.id = 'answers';
    const counts = {}, where = places();
    views().forEach((view, k) => {
      const { given, asked, question, options, key, why, says, knobs: rows, table } = states[k];
      if (!question) {
        const words = rows ? `${says || ''} <span class="given">${rows.join(', ')}.</span>` : says;
        view.after(pictures(given, words));
        if (table) view.after(made('div', 'given', table));
        return;
      }
      const chapter = Number(where[k].match(/\d+/)), number = counts[chapter] =
          (counts[chapter] || 0) + 1, id = `${chapter}-${number}`;
      const asks = made('div', 'prediction',
          `<p class="leads-on"><b>Prediction ${chapter}.${number}.</b> </p>`);
      asks.id = `prediction-${id}`;
      asks.firstChild.innerHTML += question.replace('Turn the arrow', 'Draw the arrow');
      if (options.length) {
        asks.append(made('ol', 'options'));
        options.forEach((text, place) => {
          asks.lastChild.append(made('li', '', `${letter(place)} ${text}`));
        });
      }
      asks.append(made('p', 'given', `<a href="#answer-${id}">Answer</a>`));
      view.after(asks, pictures(given));
      const answer = made('div', 'answer',
          `<p><a href="#prediction-${id}"><b>${chapter}.${number}</b></a> </p>`);
      answer.id = `answer-${id}`;
      answer.firstChild.innerHTML +=
          key >= 0 ? `${letter(key)} ${options[key].replace(/\.$/, '')}. ${why}` : why;
      answers.append(answer, pictures(asked, says));
    });
    return answers;
  }

  // The lecturer's solutions stand at the back too.
  function solutions() {
    const back = made('section', 'matter', '<h3>Solutions of the exercises</h3>');
    back.id = 'solutions';
    for (const exercise of all('section[id*="exercise-"]')) {
      all('.cell_output', exercise).filter((it) => !it.closest('.tag_hide-cell'))
          .forEach((it) => it.remove()); // that the answer has no value yet
      const parts = all(':scope > details, :scope > .tag_hide-cell', exercise);
      if (!parts.length) continue;
      const solved = made('section', '', `<h4>${wordsOf(title(exercise))}</h4>`);
      solved.id = `solution-of-${exercise.id}`;
      all('summary', exercise).forEach((it) => it.remove());
      parts.forEach((it) => solved.append(...it.childNodes));
      all('details', solved).forEach((it) => it.replaceWith(...it.childNodes));
      exercise.append(made('p', 'given', `<a href="#${solved.id}">Solution</a>`));
      back.append(solved);
    }
    return back;
  }

  // A listing stands in full, but one of many lines, or one that only calls a panel.
  function unfold() {
    for (const fold of all('details.above-input')) {
      const lines = all('.line', fold).length, panel = fold.parentElement.querySelector('figure');
      if (lines > 12 || (panel && lines < 4)) fold.remove();
      else fold.replaceWith(fold.querySelector('.cell_input'));
    }
  }

  return { all, made, title, wordsOf, begins, nameOf, places, states, still, solutions, unfold };
})();
