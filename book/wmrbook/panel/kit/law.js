// What a law commands.

import { LAWS, bodyError, polarClosingRate } from './model.js';

// (v, omega). The formula of a law for a goal that stands still gives v/rho, that of one for a
// moving goal v.
export function controlLaw(rho, alpha, theta, gains, law = 'corrected', vRef = 0, omegaRef = 0) {
  const { formula, needsReference } = LAWS[law];
  if (needsReference) return formula(...bodyError(rho, alpha, theta), vRef, omegaRef, gains);
  const twist = formula(rho, alpha, theta, gains);
  twist[0] *= rho;
  return twist;
}

/** The twist of two wheels so far apart. @param {number} left @param {number} right */
export const twistOf = (left, right, width) =>
    ({ v: (left + right) / 2, omega: (right - left) / width });

/** What the distance and what the angles add to the rate of V, (19). @param {Point} command */
export function ratesOfV([vOverRho, omega], rho, alpha, theta, h, L = 1) {
  const [nearer, turning, sweeping] = polarClosingRate(rho, alpha, vOverRho, omega);
  return [rho * nearer / L, alpha * turning + h * theta * sweeping];
}
