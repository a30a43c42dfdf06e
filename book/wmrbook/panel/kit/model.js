// Printed from wmrlib's formulas by symbolic.javascript: change those.

// sin(angle)/angle, which is 1 at 0
export function sinc(angle) {
  return ((Math.abs(angle) > 1e-08) ? ( Math.sin(angle)/angle ) : ( 1 ));
}

// (1 - exp(-k_rho rho))/rho, which is k_rho at rho = 0
export function decay(rho, k_rho) {
  return ((k_rho*Math.abs(rho) > 1e-08) ? ( -Math.expm1(-k_rho*rho)/rho ) : ( k_rho*(-1/2*k_rho*rho
    + 1) ));
}

// an angle within a turn of 0
export function turnedBack(angle) {
  return ((angle > Math.PI) ? ( angle - 2*Math.PI ) : ((angle <= -Math.PI) ? ( angle + 2*Math.PI ) :
    ( angle )));
}

// the same direction in (-pi, pi]; in float it loses 2e-7 rad with each whole turn
export function wrap(angle) {
  return ((angle <= Math.PI && angle > -Math.PI) ? ( angle ) : ( turnedBack((angle % (2*Math.PI)))
    ));
}

// (22), and the omega that the proof needs
export function correctedLaw(rho, alpha, theta, { k_rho, k_alpha, h, v_max }) {
  const v_over_rho = v_max*Math.cos(alpha)*decay(rho, k_rho);
  return [v_over_rho, alpha*k_alpha + v_over_rho*(alpha + h*theta)*sinc(alpha)];
}

// (22) and (24) as the paper prints them
export function printedLaw(rho, alpha, theta, { k_rho, k_alpha, h, v_max }) {
  const v_over_rho = v_max*Math.cos(alpha)*decay(rho, k_rho);
  return [v_over_rho, alpha*k_alpha + v_over_rho*(alpha +
    h*theta)*Math.sin(alpha)*Math.cos(alpha)*sinc(alpha)];
}

// Aicardi et al. (1995), without a speed limit
export function aicardiLaw(rho, alpha, theta, { k_rho, k_alpha, h }) {
  const v_over_rho = k_rho*Math.cos(alpha);
  return [v_over_rho, alpha*k_alpha + v_over_rho*(alpha + h*theta)*sinc(alpha)];
}

// after Todorovski et al. (2025): never crosses half a turn of alpha or theta
export function barrierLaw(rho, alpha, theta, { k_rho, k_alpha, h, v_max }) {
  const v_over_rho = v_max*Math.cos(alpha)*decay(rho, k_rho);
  return [v_over_rho, k_alpha*Math.sin(alpha) + v_over_rho*(2*h*((1/4)*Math.cos(alpha) +
    1/4)*(Math.cos(alpha) + 1)*Math.sin((1/2)*theta)/Math.pow(Math.cos((1/2)*theta), 3) +
    Math.sin(alpha))];
}

// Park and Kuipers (2011), as in Nav2: k_alpha is their k_delta, h their k_phi
export function gracefulLaw(rho, alpha, theta, { k_rho, k_alpha, h, v_max }) {
  const v_over_rho = v_max*decay(rho, k_rho);
  return [v_over_rho, v_over_rho*(k_alpha*(alpha + Math.atan(h*theta)) + (h/((h*h)*(theta*theta) +
    1) + 1)*Math.sin(alpha))];
}

// Kanayama et al. (1990), feed-forward and feedback
export function kanayamaLaw(ahead, left, turn, v_ref, omega_ref, { k_x, k_y, k_heading }) {
  return [ahead*k_x + v_ref*Math.cos(turn), omega_ref + v_ref*(k_heading*Math.sin(turn) +
    k_y*left)];
}

// feed-forward and a constant matrix, such as `control.lqr` computes
export function linearLaw(ahead, left, turn, v_ref, omega_ref, { v_x, v_y, v_heading, omega_x,
    omega_y, omega_heading }) {
  return [ahead*v_x + left*v_y + turn*v_heading + v_ref*Math.cos(turn), ahead*omega_x + left*omega_y
    + omega_heading*turn + omega_ref];
}

// the goal ahead, to the left, and turned
export function bodyError(rho, alpha, theta) {
  return [rho*Math.cos(alpha), rho*Math.sin(alpha), wrap(alpha - theta)];
}

// its Lyapunov function
export function poseValue(rho, alpha, theta, { h }) {
  return (1/2)*(alpha*alpha) + (1/2)*h*(theta*theta) + (1/2)*(rho*rho);
}

// its Lyapunov function
export function barrierValue(rho, alpha, theta, { h }) {
  const part0 = (1/2)*alpha;
  const part1 = (1/2)*theta;
  return 2*h*(Math.sin(part1)*Math.sin(part1))/(Math.cos(part1)*Math.cos(part1)) + (1/2)*(rho*rho) +
    2*(Math.sin(part0)*Math.sin(part0))/(Math.cos(part0)*Math.cos(part0));
}

// its Lyapunov function
export function gracefulValue(rho, alpha, theta, { h }) {
  const part0 = Math.atan(h*theta);
  return ((1/2)*alpha + (1/2)*part0)*(alpha + part0);
}

// its Lyapunov function
export function kanayamaValue(rho, alpha, theta, { k_y }) {
  return (1/2)*(rho*rho) + (1 - Math.cos(alpha - theta))/k_y;
}

// its Lyapunov function
export function linearValue(rho, alpha, theta) {
  return (1/2)*(rho*rho) + (1/2)*(wrap(alpha - theta)*wrap(alpha - theta));
}

// p, a, b near the goal: rho' = -p rho, and s^2 + a s + b of the angles
export function correctedModes({ k_rho, k_alpha, h, v_max }) {
  return [k_rho*v_max, k_alpha, h*(k_rho*k_rho)*(v_max*v_max)];
}

// p, a, b near the goal: rho' = -p rho, and s^2 + a s + b of the angles
export function printedModes({ k_rho, k_alpha, v_max }) {
  const part0 = k_rho*v_max;
  return [part0, k_alpha - part0, 0];
}

// p, a, b near the goal: rho' = -p rho, and s^2 + a s + b of the angles
export function aicardiModes({ k_rho, k_alpha, h }) {
  return [k_rho, k_alpha, h*(k_rho*k_rho)];
}

// p, a, b near the goal: rho' = -p rho, and s^2 + a s + b of the angles
export function barrierModes({ k_rho, k_alpha, h, v_max }) {
  return [k_rho*v_max, k_alpha, h*(k_rho*k_rho)*(v_max*v_max)];
}

// p, a, b near the goal: rho' = -p rho, and s^2 + a s + b of the angles
export function gracefulModes({ k_rho, k_alpha, h, v_max }) {
  const part0 = k_rho*v_max;
  return [part0, h*part0 + k_alpha*part0, h*k_alpha*(k_rho*k_rho)*(v_max*v_max)];
}

// method euler
export function eulerStep(x, y, heading, v, omega, dt) {
  const part0 = dt*v;
  return [part0*Math.cos(heading) + x, part0*Math.sin(heading) + y, wrap(dt*omega + heading)];
}

// method arc
export function arcStep(x, y, heading, v, omega, dt) {
  const part0 = dt*omega;
  const part1 = (1/2)*part0;
  const part2 = heading + part1;
  const part3 = dt*v*sinc(part1);
  return [part3*Math.cos(part2) + x, part3*Math.sin(part2) + y, wrap(heading + part0)];
}

// rho, alpha, theta
export function polarFromPose(x, y, heading, goal_x, goal_y, goal_heading) {
  const part0 = goal_x - x;
  const part1 = goal_y - y;
  const part2 = -Math.atan2(part1, part0);
  return [Math.sqrt((part0*part0) + (part1*part1)), wrap(-heading - part2), wrap(-goal_heading -
    part2)];
}

// theta to be used, up to pi + hysteresis; before: the last result, NaN if there is none
export function keepBranch(theta, before, hysteresis) {
  const part0 = theta + 6.283185307179586*Math.floor(0.15915494309189535*before -
    0.15915494309189535*theta + 1/2);
  return ((Math.abs(part0) < hysteresis + 3.141592653589793) ? ( part0 ) : ( theta ));
}

// the factor on it for a min_speed
export function hurry(v, alpha, min_speed) {
  const part0 = min_speed*Math.abs(v)*Math.abs(Math.cos(alpha))/((v*v) + 1e-24);
  return ((part0 < 1) ? ( 1 ) : ((part0 > 1000000000) ? ( 1000000000 ) : ( part0 )));
}

// speed of the faster wheel
export function fastestWheel(v, omega, b) {
  return (1/2)*b*Math.abs(omega) + Math.abs(v);
}

// the factor on the twist for a max_speed
export function saturationScale(max_speed, fastest) {
  return ((fastest > max_speed) ? ( max_speed/fastest ) : ( 1 ));
}

// omega of a turn on the spot by an error that is left
export function turnRate(error, gain, min_rate, max_rate) {
  const part0 = gain*Math.abs(error);
  const part1 = ((min_rate > part0) ? ( min_rate ) : ((max_rate < part0) ? ( max_rate ) : ( part0
    )));
  return ((error < 0) ? ( -part1 ) : ( part1 ));
}

// the mean twist in a period, and the left and right speeds and rests after it
export function roll(v, omega, left, right, left_rest, right_rest, b, acceleration, lag, dead_band,
    encoder_step, dt) {
  const part0 = 1/dt;
  const part1 = 1/encoder_step;
  const part2 = (1/2)*b*omega;
  const part3 = part2 + v;
  const part4 = dead_band > Math.abs(part3);
  const part5 = ((part4) ? ( part3 ) : ( 0 ));
  const part6 = -part5;
  const part7 = 1/acceleration;
  const part8 = lag - part7*Math.abs(right);
  const part9 = part3 - right;
  const part10 = lag - part7*Math.abs(part9);
  const part11 = part6 + part9;
  const part12 = Math.abs(part11);
  const part13 = (((part4 || part10 > 0) && (!part4 || part8 > 0)) ? ( 0 ) : (((part4 || dt <
    -part10) && (!part4 || dt < -part8)) ? ( dt ) : ( -lag + part12*part7 )));
  const part14 = dt - part13;
  const part15 = part11*part13/(part12*part7 + 1e-30);
  const part16 = 1/(lag + 1e-15);
  const part17 = -v;
  const part18 = part15 + right;
  const part19 = (-part17 - part18 + part2 - part5)*Math.expm1(-part14*part16);
  const part20 = lag*part19 + part13*((1/2)*part15 + right) + part14*(part3 + part6) + right_rest;
  const part21 = encoder_step > 0;
  const part22 = ((part21) ? ( encoder_step*Math.floor(part1*part20 + 1/2) ) : ( part20 ));
  const part23 = part17 + part2;
  const part24 = dead_band > Math.abs(part23);
  const part25 = ((part24) ? ( -part23 ) : ( 0 ));
  const part26 = lag - part7*Math.abs(left);
  const part27 = left + part23;
  const part28 = lag - part7*Math.abs(part27);
  const part29 = part25 + part27;
  const part30 = Math.abs(part29);
  const part31 = (((part24 || part28 > 0) && (!part24 || part26 > 0)) ? ( 0 ) : (((part24 || dt <
    -part28) && (!part24 || dt < -part26)) ? ( dt ) : ( -lag + part30*part7 )));
  const part32 = dt - part31;
  const part33 = -part29*part31/(part30*part7 + 1e-30);
  const part34 = (-part29 - part33)*Math.expm1(-part16*part32);
  const part35 = lag*part34 + left_rest + part31*(left + (1/2)*part33) + part32*(-part23 - part25);
  const part36 = ((part21) ? ( encoder_step*Math.floor(part1*part35 + 1/2) ) : ( part35 ));
  const part37 = -part22;
  return [part0*((1/2)*part22 + (1/2)*part36), part0*(-part36 - part37)/b, left + part33 - part34,
    part18 - part19, part35 - part36, part20 + part37];
}

// x, y, heading
export function poseOfError(rho, alpha, theta, goal_x, goal_y, goal_heading) {
  const part0 = goal_heading + theta;
  return [goal_x - rho*Math.cos(part0), goal_y - rho*Math.sin(part0), wrap(-alpha + part0)];
}

// (7) to (9)
export function polarClosingRate(rho, alpha, v_over_rho, omega) {
  const part0 = Math.sin(alpha);
  return [-rho*v_over_rho*Math.cos(alpha), -omega + part0*v_over_rho, part0*v_over_rho];
}

// x, y, heading, v, omega of the goal
export function circle(t) {
  const part0 = 0.15707963267948966*t;
  return [4*Math.cos(part0) - 4, 4*Math.sin(part0), part0 + 1.5707963267948966, 0.6283185307179586,
    0.15707963267948966];
}

export const LAWS = {
  corrected: { formula: correctedLaw, value: poseValue, modes: correctedModes, gains: ['k_rho',
    'k_alpha', 'h', 'v_max'], needsReference: false },
  printed: { formula: printedLaw, value: poseValue, modes: printedModes, gains: ['k_rho', 'k_alpha',
    'h', 'v_max'], needsReference: false },
  aicardi: { formula: aicardiLaw, value: poseValue, modes: aicardiModes, gains: ['k_rho', 'k_alpha',
    'h', 'v_max'], needsReference: false },
  barrier: { formula: barrierLaw, value: barrierValue, modes: barrierModes, gains: ['k_rho',
    'k_alpha', 'h', 'v_max'], needsReference: false },
  graceful: { formula: gracefulLaw, value: gracefulValue, modes: gracefulModes, gains: ['k_rho',
    'k_alpha', 'h', 'v_max'], needsReference: false },
  kanayama: { formula: kanayamaLaw, value: kanayamaValue, modes: null, gains: ['k_x', 'k_y',
    'k_heading'], needsReference: true },
  linear: { formula: linearLaw, value: linearValue, modes: null, gains: ['v_x', 'v_y', 'v_heading',
    'omega_x', 'omega_y', 'omega_heading'], needsReference: true },
};
export const STEPS = { euler: eulerStep, arc: arcStep };
export const RULE = {stages: [[0.05260015195876773], [0.0197250569845379, 0.0591751709536137],
    [0.02958758547680685, 0, 0.08876275643042054], [0.2413651341592667, 0, -0.8845494793282861,
    0.924834003261792], [0.037037037037037035, 0, 0, 0.17082860872947386, 0.12546768756682242],
    [0.037109375, 0, 0, 0.17025221101954405, 0.06021653898045596, -0.017578125],
    [0.03709200011850479, 0, 0, 0.17038392571223998, 0.10726203044637328, -0.015319437748624402,
    0.008273789163814023], [0.6241109587160757, 0, 0, -3.3608926294469414, -0.868219346841726,
    27.59209969944671, 20.154067550477894, -43.48988418106996], [0.47766253643826434, 0, 0,
    -2.4881146199716677, -0.590290826836843, 21.230051448181193, 15.279233632882423,
    -33.28821096898486, -0.020331201708508627], [-0.9371424300859873, 0, 0, 5.186372428844064,
    1.0914373489967295, -8.149787010746927, -18.52006565999696, 22.739487099350505,
    2.4936055526796523, -3.0467644718982196], [2.273310147516538, 0, 0, -10.53449546673725,
    -2.0008720582248625, -17.9589318631188, 27.94888452941996, -2.8589982771350235,
    -8.87285693353063, 12.360567175794303, 0.6433927460157636]], weights: [0.054293734116568765, 0,
    0, 0, 0, 4.450312892752409, 1.8915178993145003, -5.801203960010585, 0.3111643669578199,
    -0.1521609496625161, 0.20136540080403034, 0.04471061572777259], fifth: [0.01312004499419488,
    0.0, 0.0, 0.0, 0.0, -1.2251564463762044, -0.4957589496572502, 1.6643771824549864,
    -0.35032884874997366, 0.3341791187130175, 0.08192320648511571, -0.022355307863886294], third:
    [-0.18980075407240762, 0.0, 0.0, 0.0, 0.0, 4.450312892752409, 1.8915178993145003,
    -5.801203960010585, -0.422682321323792, -0.1521609496625161, 0.20136540080403034,
    0.02265179219836082]};
