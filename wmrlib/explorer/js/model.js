// The model's formulas, printed from sympy: change wmrlib/symbolic, then run python -m wmrlib.symbolic.

// sin(angle)/angle, which is 1 at 0
function sinc(angle, sine) {
  return ((Math.abs(angle) > 1.0e-8) ? ( sine/angle ) : ( 1 ));
}

// (1 - exp(-k_rho rho))/rho, which is k_rho at rho = 0
function decay(rho, k_rho) {
  return ((k_rho*Math.abs(rho) > 1.0e-8) ? ( -Math.expm1(-k_rho*rho)/rho ) : ( k_rho*(-1/2*k_rho*rho + 1) ));
}

// sin(angle)/angle of an angle up to 0.1, from its square
function smallSinc(square) {
  return square*(square*(square*((1/362880)*square - 1/5040) + 1/120) - 1/6) + 1;
}

// cos(angle) of an angle up to 0.1, from its square
function smallCos(square) {
  return square*(square*(square*((1/40320)*square - 1/720) + 1/24) - 1/2) + 1;
}

// v/rho by (22)
function correctedPull(rho, cos_alpha, k_rho, v_max) {
  return cos_alpha*v_max*decay(rho, k_rho);
}

// the omega that makes the proof work
function correctedOmega(alpha, theta, sinc_alpha, pull, k_alpha, h) {
  return alpha*k_alpha + pull*sinc_alpha*(alpha + h*theta);
}

// (24) as the paper prints it
function printedOmega(alpha, theta, sin_alpha, cos_alpha, sinc_alpha, pull, k_alpha, h) {
  return alpha*k_alpha + cos_alpha*pull*sin_alpha*sinc_alpha*(alpha + h*theta);
}

// v/rho of the linear law; its omega is the corrected one
function aicardiPull(cos_alpha, k_rho) {
  return cos_alpha*k_rho;
}

// how far the goal lies ahead
function bodyAhead(rho, cos_alpha) {
  return cos_alpha*rho;
}

// how far the goal lies to the left
function bodyLeft(rho, sin_alpha) {
  return rho*sin_alpha;
}

// v of the law with feed-forward
function kanayamaV(ahead, turn, v_ref, k_x) {
  return ahead*k_x + v_ref*Math.cos(turn);
}

// its omega
function kanayamaOmega(left, turn, v_ref, omega_ref, k_y, k_heading) {
  return omega_ref + v_ref*(k_heading*Math.sin(turn) + k_y*left);
}

// V, (18)
function lyapunovValue(rho, alpha, theta, h, L) {
  return (1/2)*(alpha*alpha) + (1/2)*h*(theta*theta) + (1/2)*(rho*rho)/L;
}

// its V
function kanayamaValue(ahead, left, turn, k_y) {
  return (1/2)*(ahead*ahead) + (1/2)*(left*left) + (1 - Math.cos(turn))/k_y;
}

// (7)
function rhoRate(rho, cos_alpha, pull) {
  return -cos_alpha*pull*rho;
}

// (8)
function thetaRate(sin_alpha, pull) {
  return pull*sin_alpha;
}

// (9)
function alphaRate(sin_alpha, pull, omega) {
  return -omega + pull*sin_alpha;
}

// natural frequency near the goal, with rate = v_max k_rho
function modeFrequency(rate, h) {
  return Math.sqrt(h)*rate;
}

// damping near the goal
function modeDamping(rate, k_alpha, h) {
  return (1/2)*k_alpha/(Math.sqrt(h)*rate);
}

// the rate at which the heading settles near the goal
function modeSettling(rate, k_alpha, h) {
  return ((h*(rate*rate) - 1/4*(k_alpha*k_alpha) >= 0) ? ( (1/2)*k_alpha ) : ( h*(rate*rate)/((1/2)*k_alpha + Math.sqrt(-h*(rate*rate) + (1/4)*(k_alpha*k_alpha))) ));
}

// where the paper's circle is at time t
function circleAngle(t) {
  return (1/20)*Math.PI*t;
}

// x_r
function circleX(angle) {
  return 4*Math.cos(angle) - 4;
}

// y_r
function circleY(angle) {
  return 4*Math.sin(angle);
}

// theta_r
function circleHeading(angle) {
  return angle + (1/2)*Math.PI;
}

// speed of the reference
function circleSpeed() {
  return (1/5)*Math.PI;
}

// turning rate of the reference
function circleTurn() {
  return (1/20)*Math.PI;
}
