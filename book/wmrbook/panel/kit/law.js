// What a law commands.

import { LAWS, bodyError } from './model.js';

// (v, omega). The formula of a law for a goal that stands still gives v/rho, that of one for a
// moving goal v.
export function controlLaw(rho, alpha, theta, gains, law = 'corrected', vRef = 0, omegaRef = 0) {
  const { formula, needsReference } = LAWS[law];
  if (needsReference) return formula(...bodyError(rho, alpha, theta), vRef, omegaRef, gains);
  const twist = formula(rho, alpha, theta, gains);
  twist[0] *= rho;
  return twist;
}
