// Remembers the boxes of all words that are written level on a canvas, in its pixels, until it is
// cleared; `crowdedAt(states)` says which are cut by its edge, and which lie half on another.
(() => {
  const written = new Map(), { fillText, setTransform } = CanvasRenderingContext2D.prototype;
  CanvasRenderingContext2D.prototype.setTransform = function (...to) {
    written.set(this.canvas, []);
    return setTransform.apply(this, to);
  };
  CanvasRenderingContext2D.prototype.fillText = function (text, x, y) {
    const { a, b, d, e, f } = this.getTransform(), box = this.measureText(text);
    if (Math.abs(b) < 1e-6)
      written.get(this.canvas)?.push([text, a * (x - box.actualBoundingBoxLeft) + e,
        d * (y - box.actualBoundingBoxAscent) + f, a * (x + box.actualBoundingBoxRight) + e,
        d * (y + box.actualBoundingBoxDescent) + f]);
    return fillText.call(this, text, x, y);
  };
  const area = (left, top, right, bottom) => Math.max(right - left, 0) * Math.max(bottom - top, 0);
  window.crowdedAt = async (states) => {
    const found = [], home = panel.get('state');
    for (const state of states) {
      panel.set('state', { ...home, ...state });
      await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
      if (![...written.values()].some((words) => words.length)) found.push([state, 'no words']);
      for (const [{ width, height }, words] of written)
        words.forEach(([text, left, top, right, bottom], k) => {
          if (Math.max(-left, right - width, -top, bottom - height) > 1) found.push([state, text]);
          for (const [other, ...box] of words.slice(0, k)) {
            const both = area(Math.max(left, box[0]), Math.max(top, box[1]),
                Math.min(right, box[2]), Math.min(bottom, box[3]));
            if (both > 0.5 * Math.min(area(left, top, right, bottom), area(...box)))
              found.push([state, text, other]);
          }
        });
    }
    return found;
  };
})();
