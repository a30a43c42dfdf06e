// What the drawings in live/ are made of: each imports from here what it needs.

export * from './camera.js';
export * from './model.js';
export * from './numbers.js';
export * from './runs.js';
export { DEGREES, complex, inDegrees, inWords, lengthText, written } from './style.js';
export { disc, inside } from './surface.js';
export { TRACK } from './face.js';
export { live } from './live.js';
export { stage } from './stage.js';
export { modes, polesOf, summarise } from './simulate.js';
export { normals } from './random.js';
export { cornerOf, goalFromNear, insetOf, insetSize } from './inset.js';
export { inReach, onStops } from './controls.js';
export { ratesOfV, twistOf } from './law.js';
export { roundBelow } from './lawn.js';
