// Printed from wmrlib's formulas by python -m wmrlib.symbolic: change those.

// sin(angle)/angle, which is 1 at 0
function sinc(angle) {
  return ((Math.abs(angle) > 1e-08) ? ( Math.sin(angle)/angle ) : ( 1 ));
}

// (1 - exp(-k_rho rho))/rho, which is k_rho at rho = 0
function decay(rho, k_rho) {
  return ((k_rho*Math.abs(rho) > 1e-08) ? ( -Math.expm1(-k_rho*rho)/rho ) : ( k_rho*(-1/2*k_rho*rho + 1) ));
}

// an angle within a turn of 0
function turnedBack(angle) {
  return ((angle > Math.PI) ? ( angle - 2*Math.PI ) : ((angle <= -Math.PI) ? ( angle + 2*Math.PI ) : ( angle )));
}

// the same direction in (-pi, pi]; in float it loses 2e-7 rad with each whole turn
function wrap(angle) {
  return ((angle <= Math.PI && angle > -Math.PI) ? ( angle ) : ( turnedBack((angle % (2*Math.PI))) ));
}

// (22), and the omega that the proof needs
function correctedLaw(rho, alpha, theta, { k_rho, k_alpha, h, v_max }) {
  const v_over_rho = v_max*Math.cos(alpha)*decay(rho, k_rho);
  return [rho*v_over_rho, alpha*k_alpha + v_over_rho*(alpha + h*theta)*sinc(alpha)];
}

// (22) and (24) as the paper prints them
function printedLaw(rho, alpha, theta, { k_rho, k_alpha, h, v_max }) {
  const v_over_rho = v_max*Math.cos(alpha)*decay(rho, k_rho);
  return [rho*v_over_rho, alpha*k_alpha + v_over_rho*(alpha + h*theta)*Math.sin(alpha)*Math.cos(alpha)*sinc(alpha)];
}

// Aicardi et al. (1995), without a speed limit
function aicardiLaw(rho, alpha, theta, { k_rho, k_alpha, h }) {
  const v_over_rho = k_rho*Math.cos(alpha);
  return [rho*v_over_rho, alpha*k_alpha + v_over_rho*(alpha + h*theta)*sinc(alpha)];
}

// Kanayama et al. (1990), feed-forward and feedback
function kanayamaLaw(rho, alpha, theta, { k_x, k_y, k_heading }, v_ref, omega_ref) {
  const part0 = alpha - theta;
  return [k_x*rho*Math.cos(alpha) + v_ref*Math.cos(part0), omega_ref + v_ref*(k_heading*Math.sin(part0) + k_y*rho*Math.sin(alpha))];
}

// feed-forward and a constant matrix, such as `control.lqr` computes
function linearLaw(rho, alpha, theta, { v_x, v_y, v_heading, omega_x, omega_y, omega_heading }, v_ref, omega_ref) {
  const part0 = rho*Math.cos(alpha);
  const part1 = rho*Math.sin(alpha);
  const part2 = alpha - theta;
  const part3 = wrap(part2);
  return [part0*v_x + part1*v_y + part3*v_heading + v_ref*Math.cos(part2), omega_heading*part3 + omega_ref + omega_x*part0 + omega_y*part1];
}

// its Lyapunov function
function poseValue(rho, alpha, theta, { h }) {
  return (1/2)*(alpha*alpha) + (1/2)*h*(theta*theta) + (1/2)*(rho*rho);
}

// its Lyapunov function
function kanayamaValue(rho, alpha, theta, { k_y }) {
  return (1/2)*(rho*rho) + (1 - Math.cos(alpha - theta))/k_y;
}

// its Lyapunov function
function linearValue(rho, alpha, theta) {
  return (1/2)*(rho*rho) + (1/2)*(wrap(alpha - theta)*wrap(alpha - theta));
}

// p, a, b near the goal: rho' = -p rho, and s^2 + a s + b of the angles
function correctedModes({ k_rho, k_alpha, h, v_max }) {
  return [k_rho*v_max, k_alpha, h*(k_rho*k_rho)*(v_max*v_max)];
}

// p, a, b near the goal: rho' = -p rho, and s^2 + a s + b of the angles
function printedModes({ k_rho, k_alpha, v_max }) {
  const part0 = k_rho*v_max;
  return [part0, k_alpha - part0, 0];
}

// p, a, b near the goal: rho' = -p rho, and s^2 + a s + b of the angles
function aicardiModes({ k_rho, k_alpha, h }) {
  return [k_rho, k_alpha, h*(k_rho*k_rho)];
}

// method euler
function eulerStep(x, y, heading, v, omega, dt) {
  const part0 = dt*v;
  return [part0*Math.cos(heading) + x, part0*Math.sin(heading) + y, wrap(dt*omega + heading)];
}

// method arc
function arcStep(x, y, heading, v, omega, dt) {
  const part0 = dt*omega;
  const part1 = (1/2)*part0;
  const part2 = heading + part1;
  const part3 = dt*v*sinc(part1);
  return [part3*Math.cos(part2) + x, part3*Math.sin(part2) + y, wrap(heading + part0)];
}

// rho, alpha, theta
function polarFromPose(x, y, heading, goal_x, goal_y, goal_heading) {
  const part0 = goal_x - x;
  const part1 = goal_y - y;
  const part2 = -Math.atan2(part1, part0);
  return [Math.sqrt((part0*part0) + (part1*part1)), wrap(-heading - part2), wrap(-goal_heading - part2)];
}

// x, y, heading, v, omega of the goal
function circle(t) {
  const part0 = (1/20)*Math.PI;
  const part1 = part0*t;
  return [4*Math.cos(part1) - 4, 4*Math.sin(part1), part1 + (1/2)*Math.PI, 0.6283185307179586, part0];
}

const LAWS = {
  corrected: { command: correctedLaw, value: poseValue, modes: correctedModes, gains: ['k_rho', 'k_alpha', 'h', 'v_max'], needsReference: false },
  printed: { command: printedLaw, value: poseValue, modes: printedModes, gains: ['k_rho', 'k_alpha', 'h', 'v_max'], needsReference: false },
  aicardi: { command: aicardiLaw, value: poseValue, modes: aicardiModes, gains: ['k_rho', 'k_alpha', 'h', 'v_max'], needsReference: false },
  kanayama: { command: kanayamaLaw, value: kanayamaValue, modes: null, gains: ['k_x', 'k_y', 'k_heading'], needsReference: true },
  linear: { command: linearLaw, value: linearValue, modes: null, gains: ['v_x', 'v_y', 'v_heading', 'omega_x', 'omega_y', 'omega_heading'], needsReference: true },
};
const STEPS = { euler: eulerStep, arc: arcStep };
