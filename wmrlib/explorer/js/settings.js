// From the widget's traits to what `simulate` takes, and what is wrong with them, in words.

const GAINS = ['k_rho', 'k_alpha', 'h', 'v_max'], FEEDBACK = ['k_x', 'k_y', 'k_heading'];
// One gain out of each group of sliders that appear together.
const GROUPS = { gains: 'k_rho', limit: 'v_max', feedback: 'k_x' };
const LONGEST = 100_000; // steps: what a frame still has time for
const FARTHEST = 1e6; // m: beyond, the plane is no longer a map

const pick = (model, names) => Object.fromEntries(names.map((name) => [name, model.get(name)]));

// The row of the law in force in the table of laws that the panel is given.
function lawOf(model) {
  const moving = model.get('scenario') === 1, laws = model.get('laws').filter((law) => moving || !law.needs_reference);
  return laws[model.get(moving ? 'circle_law' : 'pose_law')];
}

function settingsOf(model) {
  return {
    start: model.get('start'), goal: model.get('goal'), reference: model.get('scenario') === 1 ? 'circle' : null,
    law: lawOf(model).name, method: model.get('methods')[model.get('method')],
    gains: pick(model, GAINS), feedback: pick(model, FEEDBACK),
    dt: model.get('dt'), duration: model.get('duration'), arrivalRadius: model.get('arrival_radius'),
  };
}

// One run, with the goal's columns also where it stands still. Throws RangeError, which names what is not allowed.
function runOf(settings) {
  const { dt, duration, goal } = settings;
  if (duration / dt > LONGEST) throw notAllowed('dt', dt, `at least ${duration / LONGEST} s`);
  for (const [name, pose] of Object.entries({ start: settings.start, goal })) {
    if (pose && pose.some((value) => Math.abs(value) > FARTHEST)) throw notAllowed(name, pose, `at most ${FARTHEST} m from the origin`);
  }
  const run = simulate(settings);
  if (run.n === 0) throw new RangeError('the run leaves the range of numbers at its start');
  if (settings.reference === null) {
    ['goalX', 'goalY', 'goalHeading'].forEach((name, i) => { run[name] = new Float64Array(run.n).fill(goal[i]); });
  }
  return run;
}

// Which of the sliders and menus apply: traits that are tied to the display of their layouts.
function displaysOf(model) {
  const moving = model.get('scenario') === 1, { gains } = lawOf(model);
  const shown = { pose_law: !moving, circle_law: moving, map: model.get('view') === 1 };
  for (const [group, gain] of Object.entries(GROUPS)) shown[group] = gains.includes(gain);
  return Object.entries(shown).map(([name, on]) => [`${name}_display`, on ? 'flex' : 'none']);
}

const same = (a, b) => (Array.isArray(a) ? Array.isArray(b) && a.every((each, i) => same(each, b[i])) : a === b || Math.abs(a - b) < 1e-9);

// The number in the menu of the preset that is in force, 0 for none.
function presetOf(model) {
  return 1 + model.get('presets').findIndex((preset) => Object.entries(preset).every(([name, value]) => same(value, model.get(name))));
}
