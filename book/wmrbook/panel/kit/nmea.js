// The positions of an NMEA log, as wmrlib's read_track has them: each epoch once, by RTK or else by
// the kind of sentence that is trusted most, and none where that kind says that there is no fix.
// Times are not compared with one another here.

const SENTENCE = /\$([A-Za-z]{2}([A-Z]{3}),[^$*\r\n]*)\*([0-9A-Fa-f]{2})/gi,
    COMMENT = /^#[^\r\n\ufffd\0]*$/gm, // not in UBX between the sentences
    CLOCK = /^([01]\d|2[0-3])([0-5]\d)((?:[0-5]\d|60)(?:\.\d*)?)$/,
    PLACE = /^(\d{2})([0-5]\d\.\d+),([NS]),(\d{3})([0-5]\d\.\d+),([EW])$/;
// The most trusted first: where its time, its place, its modes and its status are.
const KINDS = { GGA: [1, 2, 6, 7], GNS: [1, 2, 6, 7], RMC: [1, 3, 12, 2], GLL: [5, 1, 7, 6] };
// Modes of GGA and of the others, by how far they are trusted: plain to RTK fixed.
const TRUST = ['1A', '29D', '3P', '5F', '4R'];

// What a sentence says: its clock, its rank, how far it is trusted, and its point or null;
// undefined if nothing.
/** @param {RegExpMatchArray} match */
function said(match) {
  const [, body, kind, sum] = match;
  const rank = Object.keys(KINDS).indexOf(kind.toUpperCase());
  const folded = [...body].reduce((all, letter) => all ^ letter.charCodeAt(0), 0);
  if (rank < 0 || folded !== parseInt(sum, 16)) return undefined;
  const [atTime, atPlace, atModes, atStatus] = Object.values(KINDS)[rank],
      fields = [...body.split(','), ...Array(13).fill('')];
  const clock = CLOCK.exec(fields[atTime]), status = fields[atStatus],
      modes = fields[atModes] || (rank > 1 ? 'A' : '');
  const sound = rank > 1 ? status === 'A' : status !== '0' && status !== '00',
      fixed = sound && (rank ? /[ADPRF]/ : /^[123459]$/).test(modes);
  if (!clock) return undefined;
  const seconds = 3600 * Number(clock[1]) + 60 * Number(clock[2]) + Number(clock[3]);
  if (!fixed) return { seconds, rank, trust: 0, point: null };
  const place = PLACE.exec(fields.slice(atPlace, atPlace + 4).join(','));
  if (!place) return undefined;
  const lat = Number(place[1]) + Number(place[2]) / 60,
      lon = Number(place[4]) + Number(place[5]) / 60;
  const trust = 1 + TRUST.findLastIndex((modes) =>
    [...fields[atModes]].some((mode) => modes.includes(mode)));
  const point = [place[3] === 'S' ? -lat : lat, place[6] === 'W' ? -lon : lon];
  return { seconds, rank, trust, point };
}

// The point of an epoch's sentences, or null.
function best(epoch) {
  const kind = Math.min(...epoch.map(({ rank }) => rank)),
      fixes = epoch.filter(({ point }) => point);
  if (!fixes.some(({ rank }) => rank === kind)) return null;
  fixes.sort((a, b) =>
    Math.max(b.trust, 3) - Math.max(a.trust, 3) || a.rank - b.rank || b.trust - a.trust);
  const [lat, lon] = fixes[0].point;
  return Math.abs(lat) <= 90 && Math.abs(lon) <= 180 ? fixes[0].point : null;
}

// Whether a point is (0, 0), as of a receiver without a fix.
const nowhere = (point) => largest(point) < 1e-6,
    largest = ([lat, lon]) => Math.max(Math.abs(lat), Math.abs(lon));

/** The points of a log, [latitude, longitude] in degrees. @param {string} text */
export function pointsOf(text) {
  const epochs = [];
  for (const match of text.replace(COMMENT, '').matchAll(SENTENCE)) {
    const one = said(match), last = epochs[epochs.length - 1];
    if (one && last?.[0].seconds === one.seconds) last.push(one);
    else if (one) epochs.push([one]);
  }
  const points = epochs.map(best).filter((point) => point),
      others = points.filter((point) => !nowhere(point)).map(largest).sort((a, b) => a - b);
  const elsewhere = !others.length || others[others.length >> 1] > 1;
  return elsewhere ? points.filter((point) => !nowhere(point)) : points;
}
