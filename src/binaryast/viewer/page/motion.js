"use strict";
// Where bodies are at any time, from the rows of a run. Numbers only, no drawing: it runs wherever JavaScript does.
// Quaternions are [x, y, z, w], body frame -> inertial; lengths are in the page's unit, times in seconds.

const Motion = (() => {
  function unpacked(text, Kind) {
    const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
    return new Kind(bytes.buffer);
  }

  function product([a, b, c, d], [x, y, z, w]) {
    return [
      d * x + a * w + b * z - c * y,
      d * y - a * z + b * w + c * x,
      d * z + a * y - b * x + c * w,
      d * w - a * x - b * y - c * z,
    ];
  }

  const inverse = ([x, y, z, w]) => [-x, -y, -z, w];

  // The turn by a rotation vector, and the shortest rotation vector of a turn.
  function turnBy([x, y, z]) {
    const angle = Math.hypot(x, y, z);
    const part = angle > 1e-12 ? Math.sin(angle / 2) / angle : 0.5;
    return [part * x, part * y, part * z, Math.cos(angle / 2)];
  }

  function vectorOf([x, y, z, w]) {
    const size = Math.hypot(x, y, z), sign = w < 0 ? -1 : 1;
    const part = size > 1e-12 ? (2 * sign * Math.atan2(size, Math.abs(w))) / size : 2 * sign;
    return [part * x, part * y, part * z];
  }

  // The turn whose matrix has these columns, which are at right angles.
  function turnOf([a, b, c], [d, e, f], [g, h, i]) {
    const trace = a + e + i;
    if (trace > 0) {
      const s = 2 * Math.sqrt(1 + trace);
      return [(f - h) / s, (g - c) / s, (b - d) / s, s / 4];
    }
    if (a >= e && a >= i) {
      const s = 2 * Math.sqrt(1 + a - e - i);
      return [s / 4, (b + d) / s, (c + g) / s, (f - h) / s];
    }
    if (e >= i) {
      const s = 2 * Math.sqrt(1 - a + e - i);
      return [(b + d) / s, s / 4, (f + h) / s, (g - c) / s];
    }
    const s = 2 * Math.sqrt(1 - a - e + i);
    return [(c + g) / s, (f + h) / s, s / 4, (b - d) / s];
  }

  function turned([x, y, z, w], [a, b, c]) {
    const [p, q, r] = product(product([x, y, z, w], [a, b, c, 0]), [-x, -y, -z, w]);
    return [p, q, r];
  }

  const cross = ([a, b, c], [x, y, z]) => [b * z - c * y, c * x - a * z, a * y - b * x];
  const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
  const scaled = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
  const size = (a) => Math.hypot(a[0], a[1], a[2]);

  function of(data, count) {
    const time = unpacked(data.time, Float64Array);
    const position = unpacked(data.position, Float32Array), velocity = unpacked(data.velocity, Float32Array);
    const quaternion = unpacked(data.quaternion, Float32Array), spin = unpacked(data.spin, Float32Array);
    const turning = data.turning, last = time.length - 1;

    // The row at or before a time; of two at the same time, the one after the impulse.
    function rowAt(t) {
      let low = 0, high = last;
      while (low < high) {
        const middle = (low + high + 1) >> 1;
        if (time[middle] <= t) low = middle; else high = middle - 1;
      }
      return low;
    }

    const three = (array, at) => [array[at], array[at + 1], array[at + 2]];

    // Place and velocity: the polynomial of degree 3 through those of the rows before and after.
    function at(t, body) {
      const k = rowAt(t), here = 3 * (k * count + body);
      const x = three(position, here), v = three(velocity, here);
      if (k === last) return { place: x, velocity: v };
      const h = time[k + 1] - time[k], s = Math.max(0, (t - time[k]) / h), there = here + 3 * count;
      const place = [0, 0, 0], speed = [0, 0, 0];
      for (let i = 0; i < 3; i++) {
        const d = position[there + i] - x[i], a = v[i] * h, b = velocity[there + i] * h;
        const second = 3 * d - 2 * a - b, third = a + b - 2 * d;
        place[i] = x[i] + s * (a + s * (second + s * third));
        speed[i] = (a + s * (2 * second + 3 * s * third)) / h;
      }
      return { place, velocity: speed };
    }

    // Attitude: the mean spin between rows turns a body evenly; what it leaves at the row after is spread evenly too.
    function attitude(t, body) {
      const among = turning.indexOf(body);
      if (among < 0) return [0, 0, 0, 1];
      const k = rowAt(t), number = turning.length, here = k * number + among;
      const q = Array.from(quaternion.subarray(4 * here, 4 * here + 4));
      if (k === last) return q;
      const there = here + number, h = time[k + 1] - time[k], s = Math.max(0, (t - time[k]) / h);
      const next = Array.from(quaternion.subarray(4 * there, 4 * there + 4));
      const mean = [0, 1, 2].map((i) => (h * (spin[3 * here + i] + spin[3 * there + i])) / 2);
      const left = vectorOf(product(inverse(turnBy(mean)), product(inverse(q), next)));
      return product(product(q, turnBy(scaled(mean, s))), turnBy(scaled(left, s)));
    }

    // Axes to be looked from: where their origin is, and the turn inertial -> shown.
    function shown(t, axes) {
      if (axes.kind === "body") {
        return { origin: at(t, axes.body).place, turn: inverse(attitude(t, axes.body)) };
      }
      if (axes.kind === "line" && count > 1) {
        const one = at(t, 0), two = at(t, axes.body);
        const line = minus(two.place, one.place), far = size(line);
        const pole = cross(line, minus(two.velocity, one.velocity)), swing = size(pole);
        if (far > 0 && swing > 0) {
          const x = scaled(line, 1 / far), z = scaled(pole, 1 / swing);
          return { origin: [0, 0, 0], turn: inverse(turnOf(x, cross(z, x), z)) };
        }
      }
      return { origin: [0, 0, 0], turn: [0, 0, 0, 1] };
    }

    return { time, last, count, rowAt, at, attitude, shown };
  }

  return { of, unpacked, product, inverse, turned, minus, size };
})();

if (typeof module !== "undefined") module.exports = Motion; // for tests without a page
