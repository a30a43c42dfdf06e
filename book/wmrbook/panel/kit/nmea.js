// The positions of an NMEA log, as wmrlib's read_track has them: each epoch once, by the kind of
// sentence that is trusted most, and none where that one says that there is no fix.

const SENTENCE = /\$([A-Za-z]{2}([A-Z]{3}),[^$*\r\n]*)\*([0-9A-Fa-f]{2})/gi,
    COMMENT = /^#[^\r\n\ufffd\0]*$/gm, // not in UBX between the sentences
    CLOCK = /^([01]\d|2[0-3])([0-5]\d)([0-5]\d(?:\.\d*)?)$/,
    PLACE = /^(\d{2})([0-5]\d\.\d+),([NS]),(\d{3})([0-5]\d\.\d+),([EW])$/;
// The most trusted first: where its time, its place, its modes and its status are.
const KINDS = { GGA: [1, 2, 6, 7], GNS: [1, 2, 6, 7], RMC: [1, 3, 12, 2], GLL: [5, 1, 7, 6] };

// What a sentence says: its clock, its rank, and its point or null; undefined if nothing.
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
  if (!fixed) return { seconds, rank, point: null };
  const place = PLACE.exec(fields.slice(atPlace, atPlace + 4).join(','));
  if (!place) return undefined;
  const lat = Number(place[1]) + Number(place[2]) / 60,
      lon = Number(place[4]) + Number(place[5]) / 60;
  return { seconds, rank, point: [place[3] === 'S' ? -lat : lat, place[6] === 'W' ? -lon : lon] };
}

/** The points of a log, [latitude, longitude] in degrees. @param {string} text */
export function pointsOf(text) {
  const points = [];
  let epoch = null;
  const close = () => {
    if (epoch?.point && Math.abs(epoch.point[0]) <= 90 && Math.abs(epoch.point[1]) <= 180)
      points.push(epoch.point);
  };
  for (const match of text.replace(COMMENT, '').matchAll(SENTENCE)) {
    const one = said(match);
    if (!one) continue;
    if (epoch?.seconds !== one.seconds) {
      close();
      epoch = one;
    } else if (one.rank < epoch.rank) epoch = one;
  }
  close();
  return points;
}
