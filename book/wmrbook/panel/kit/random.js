// Random numbers that are counted, not drawn in turn: those of a fix follow from the seed, from the
// number of its run and from its sample, as for wmrlib's receivers: those of positions in stream 0,
// those of lines of sight in stream 1.

const WORD = 2 ** 32, KEYS = [0x9E3779B9, 0xBB67AE85];

// The upper word of the product of two words.
function upper(a, b) {
  const low = (a & 0xFFFF) * (b & 0xFFFF), left = (a >>> 16) * (b & 0xFFFF) + (low >>> 16);
  const right = (a & 0xFFFF) * (b >>> 16) + left % 65536;
  return (a >>> 16) * (b >>> 16) + Math.floor(left / 65536) + Math.floor(right / 65536);
}

// Philox 4x32-10 of Salmon et al. (2011): four random words.
function philox([a, b, c, d], key) {
  let [one, two] = key;
  for (let round = 0; round < 10; round += 1) {
    const left = upper(0xCD9E8D57, c), right = upper(0xD2511F53, a); // of the products below
    [a, b, c, d] = [(left ^ b ^ one) >>> 0, Math.imul(0xCD9E8D57, c) >>> 0,
      (right ^ d ^ two) >>> 0, Math.imul(0xD2511F53, a) >>> 0];
    one = (one + KEYS[0]) % WORD;
    two = (two + KEYS[1]) % WORD;
  }
  return [a, b, c, d];
}

// Two standard normal numbers, by the rule of Box and Muller, out of 53 bits each.
export function normals(run, sample, seed, stream = 0) {
  const [a, b, c, d] = philox([run, 0, sample, stream], [seed % WORD, Math.floor(seed / WORD)]);
  const size = (a * 2 ** 21 + (b >>> 11) + 0.5) * 2 ** -53;
  const turn = 2 * Math.PI * (c * 2 ** 21 + (d >>> 11)) * 2 ** -53;
  const length = Math.sqrt(-2 * Math.log(size));
  return [length * Math.cos(turn), length * Math.sin(turn)];
}
