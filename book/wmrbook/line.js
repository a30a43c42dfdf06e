// Makes the lines of wmrbook.lines in a page that is opened from the disk, where crypto.subtle may
// be missing.
const wmrLine = (() => {
  const roots = [], primes = [];
  for (let n = 2; primes.length < 64; n += 1) if (primes.every((p) => n % p)) primes.push(n);
  const fraction = (x) => ((x - Math.floor(x)) * 2 ** 32) | 0;
  for (const p of primes) roots.push(fraction(Math.cbrt(p)));
  const turn = (x, by) => (x >>> by) | (x << (32 - by));

  /** The SHA-256 of a text in ASCII, in hexadecimal digits. */
  function sha256(text) {
    const bytes = [...text].map((it) => it.charCodeAt(0)), bits = 8 * bytes.length;
    bytes.push(0x80);
    while (bytes.length % 64 !== 56) bytes.push(0);
    // a line has far less than 2^32 bits
    bytes.push(0, 0, 0, 0, ...[24, 16, 8, 0].map((by) => (bits >>> by) & 255));
    const sum = primes.slice(0, 8).map((p) => fraction(Math.sqrt(p)));
    for (let at = 0; at < bytes.length; at += 64) {
      const w = [];
      for (let k = 0; k < 64; k += 1) {
        const old = (back) => w[k - back];
        w.push(k < 16
          ? bytes.slice(at + 4 * k, at + 4 * k + 4).reduce((word, byte) => (word << 8) | byte, 0)
          : (old(16) + (turn(old(15), 7) ^ turn(old(15), 18) ^ (old(15) >>> 3)) + old(7)
              + (turn(old(2), 17) ^ turn(old(2), 19) ^ (old(2) >>> 10))) | 0);
      }
      let [a, b, c, d, e, f, g, h] = sum;
      for (let k = 0; k < 64; k += 1) {
        const one = (h + (turn(e, 6) ^ turn(e, 11) ^ turn(e, 25)) + ((e & f) ^ (~e & g)) + roots[k]
            + w[k]) | 0;
        const two = ((turn(a, 2) ^ turn(a, 13) ^ turn(a, 22)) + ((a & b) ^ (a & c) ^ (b & c))) | 0;
        [a, b, c, d, e, f, g, h] = [(one + two) | 0, a, b, c, (d + one) | 0, e, f, g];
      }
      [a, b, c, d, e, f, g, h].forEach((it, k) => { sum[k] = (sum[k] + it) | 0; });
    }
    return sum.map((it) => (it >>> 0).toString(16).padStart(8, '0')).join('');
  }

  const quoted = (text) =>
      encodeURIComponent(text)
      .replace(/[!'()*]/g, (it) => `%${it.charCodeAt(0).toString(16).toUpperCase()}`);
  const clean = (text) => text.normalize('NFC').trim().split(/\s+/).join(' ');

  /** The line, or '' while the name is not one of 1 to 60 characters with a letter or digit. */
  return (kind, id, name, value) => {
    const who = clean(name);
    if ([...who].length > 60 || !/[\p{L}\p{N}]/u.test(who) || /[\p{Cc}\p{Cs}]/u.test(who))
      return '';
    const text = `wmr-${kind} id=${id} name=${quoted(who)} value=${quoted(clean(String(value)))}`;
    return `${text} check=${sha256(text).slice(0, 10)}`;
  };
})();
