// From the widget's traits to what `simulate` takes, and what is wrong with them, in words.

const POSE_LAWS = ['corrected', 'printed', 'aicardi'];
const CIRCLE_LAWS = [...POSE_LAWS, 'kanayama'];
const METHODS = ['arc', 'euler'];
const GAINS = ['k_rho', 'k_alpha', 'h', 'v_max'], FEEDBACK = ['k_x', 'k_y', 'k_heading'];
const LONGEST = 100_000; // steps: what a frame still has time for
const FARTHEST = 1e6; // m: beyond, the plane is no longer a map

const pick = (model, names) => Object.fromEntries(names.map((name) => [name, model.get(name)]));

function settingsOf(model) {
  const moving = model.get('scenario') === 1;
  return {
    start: model.get('start'), goal: model.get('goal'), reference: moving ? 'circle' : null,
    law: moving ? CIRCLE_LAWS[model.get('circle_law')] : POSE_LAWS[model.get('pose_law')], method: METHODS[model.get('method')],
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
  const moving = model.get('scenario') === 1, forward = moving && CIRCLE_LAWS[model.get('circle_law')] === 'kanayama';
  const limited = !forward && (moving ? CIRCLE_LAWS[model.get('circle_law')] : POSE_LAWS[model.get('pose_law')]) !== 'aicardi';
  const shown = { gains: !forward, limit: limited, feedback: forward, pose_law: !moving, circle_law: moving, map: model.get('view') === 1 };
  return Object.entries(shown).map(([name, on]) => [`${name}_display`, on ? 'flex' : 'none']);
}

const same = (a, b) => (Array.isArray(a) ? Array.isArray(b) && a.every((each, i) => same(each, b[i])) : a === b || Math.abs(a - b) < 1e-9);

// The number in the menu of the preset that is in force, 0 for none.
function presetOf(model) {
  return 1 + model.get('presets').findIndex((preset) => Object.entries(preset).every(([name, value]) => same(value, model.get(name))));
}
