// Printed by book/tools/kit.py from wmrbook.face: colours on light and on dark paper,
// fonts, and the robot.
export const COLOURS = {
  paper: ['#fdfcf8', '#15191e'],
  ink: ['#1d2429', '#eef1f4'],
  soft: ['#57606a', '#b1bac4'],
  line: ['#cdcbc1', '#424a53'],
  raised: ['#f2f0e8', '#22272e'],
  focus: ['#0069a6', '#56b4e9'],
  lawn: ['#e1ead2', '#1c261c'],
  mown: ['#d5e0c2', '#233024'],
  path: ['#0072b2', '#56b4e9'],
  start: ['#00795a', '#2fc796'],
  goal: ['#b84f00', '#f58d3d'],
  rho: ['#7a3fb8', '#c3a2f2'],
  alpha: ['#a8447f', '#e59cc4'],
  theta: ['#7d7000', '#f0e442'],
  h: ['#4a7800', '#a5d65c'],
  V: ['#3a55c9', '#95aaff'],
  rising: ['#d00000', '#ff7b72'],
  ghost: ['#7a828b', '#9aa4af'],
};
export const FONTS = {
  serif: '"Source Serif 4", Georgia, "Times New Roman", serif',
  sans: '"Source Sans 3", "Source Sans Pro", system-ui, "Segoe UI", Roboto, Arial, sans-serif',
  code: '"JetBrains Mono", ui-monospace, Menlo, Consolas, monospace',
  maths: '"STIX Two Text", "Source Serif 4", "Cambria Math", Georgia, serif',
};
export const TRACK = 23; // px, between the middles of a robot's wheels
export const ROBOT = {
  wheels: 'M-6 -14.5 L6 -14.5 Q8 -14.5 8 -12.5 L8 -10.5 Q8 -8.5 6 -8.5 L-6 -8.5 Q-8 -8.5 -8 -10.5 '
    + 'L-8 -12.5 Q-8 -14.5 -6 -14.5 Z M-6 8.5 L6 8.5 Q8 8.5 8 10.5 L8 12.5 Q8 14.5 6 14.5 L-6 '
    + '14.5 Q-8 14.5 -8 12.5 L-8 10.5 Q-8 8.5 -6 8.5 Z',
  body: 'M-11 -9 Q-13 -9 -13 -7 L-13 7 Q-13 9 -11 9 L4 9 Q9 8 15 0 Q9 -8 4 -9 Z',
  nose: 'M5 -4 L10.5 0 L5 4 Z',
};
