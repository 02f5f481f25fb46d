"use strict";
// What is said of a time: the clock, and what should be conserved, as numbers and as curves of its errors.

const INKS = ["#f0b35a", "#7fb2e5", "#d98fd0", "#8fc98a"];

// A time as one would write it: in the largest unit of which it holds at least two.
function spanText(seconds) {
  const size = Math.abs(seconds);
  for (const [unit, length] of [["d", 86400], ["h", 3600], ["min", 60]]) {
    if (size >= 2 * length) return `${(seconds / length).toPrecision(5)} ${unit}`;
  }
  return `${size === 0 || size >= 1e-3 ? Number(seconds.toPrecision(5)) : seconds.toExponential(2)} s`;
}

// The date of a time since an epoch, which is of TDB, a scale without leap seconds, as is JavaScript's.
function dateText(epoch, seconds) {
  const date = new Date(Date.parse(`${epoch}Z`) + 1000 * seconds);
  return Number.isNaN(date.getTime()) ? "" : `${date.toISOString().slice(0, 19).replace("T", " ")} TDB`;
}

const figure = (value, digits) => (value === 0 ? "0" : value.toExponential(digits));

class Panel {
  constructor(run, motion, table, chart) {
    this.motion = motion;
    this.chart = chart;
    this.kept = run.kept.map((one, i) => {
      const row = table.insertRow(), head = document.createElement("th");
      head.scope = "row";
      head.textContent = one.name;
      head.title = `error relative to ${one.scale}`;
      head.style.setProperty("--of", INKS[i]);
      row.append(head);
      return {
        ...one,
        values: Motion.unpacked(one.values, Float64Array),
        errors: Motion.unpacked(one.errors, Float32Array),
        value: row.insertCell(),
        error: row.insertCell(),
        ink: INKS[i],
      };
    });
    const sizes = this.kept.flatMap((one) => Array.from(one.errors)).filter((error) => error > 0);
    this.top = Math.ceil(Math.log10(sizes.reduce((a, b) => Math.max(a, b), 1e-15)));
    this.bottom = Math.min(this.top - 2, Math.max(-17, Math.floor(Math.log10(sizes.reduce((a, b) => Math.min(a, b), 1)))));
  }

  say(t) {
    const row = this.motion.rowAt(t);
    for (const one of this.kept) {
      one.value.textContent = one.unit ? `${figure(one.values[row], 4)} ${one.unit}` : "";
      one.error.textContent = figure(one.errors[row], 1);
    }
    this.draw(t);
  }

  // The curves are drawn once, and again where the size changes; the line of time is over them.
  draw(t) {
    const { chart } = this, width = chart.clientWidth, height = chart.clientHeight, ratio = window.devicePixelRatio;
    if (!width) return;
    if (chart.width !== Math.round(width * ratio)) {
      [chart.width, chart.height] = [Math.round(width * ratio), Math.round(height * ratio)];
      this.curves = null;
    }
    const pen = chart.getContext("2d");
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    if (!this.curves) {
      pen.clearRect(0, 0, width, height);
      this.drawCurves(pen, width, height);
      this.curves = pen.getImageData(0, 0, chart.width, chart.height);
    } else pen.putImageData(this.curves, 0, 0);
    pen.strokeStyle = "#e8e6e1";
    pen.beginPath();
    pen.moveTo(this.across(t, width), 4);
    pen.lineTo(this.across(t, width), height - 4);
    pen.stroke();
  }

  across(t, width) {
    const { time, last } = this.motion;
    return 40 + ((width - 46) * (t - time[0])) / (time[last] - time[0] || 1);
  }

  drawCurves(pen, width, height) {
    const up = (error) => {
      const part = (Math.log10(Math.max(error, 1e-300)) - this.bottom) / (this.top - this.bottom);
      return height - 8 - Math.max(0, Math.min(1, part)) * (height - 16);
    };
    pen.font = "11px system-ui, sans-serif";
    pen.textBaseline = "middle";
    pen.lineWidth = 1;
    const stride = Math.max(1, Math.ceil((this.top - this.bottom) / 5));
    for (let power = this.bottom; power <= this.top; power += stride) {
      const y = up(10 ** power);
      pen.fillStyle = "#a9a7a2";
      pen.fillText(`1e${power}`, 2, y);
      pen.strokeStyle = "#343b46";
      pen.beginPath();
      pen.moveTo(40, y);
      pen.lineTo(width - 6, y);
      pen.stroke();
    }
    for (const one of this.kept) {
      pen.strokeStyle = one.ink;
      pen.beginPath();
      one.errors.forEach((error, k) => pen.lineTo(this.across(this.motion.time[k], width), up(error)));
      pen.stroke();
    }
  }
}
