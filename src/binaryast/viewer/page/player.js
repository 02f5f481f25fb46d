"use strict";
// Time: what plays, what is pressed, and when there is something new to draw.

(() => {
  const by = (id) => document.getElementById(id);
  const run = JSON.parse(by("run").textContent);
  const motion = Motion.of(run.motion, run.bodies.length);
  const begin = motion.time[0], end = motion.time[motion.last];
  const state = { time: begin, playing: false, drawn: 0, stale: true, before: 0 };
  const stale = () => { state.stale = true; };
  by("title").textContent = run.title;
  by("summary").textContent = `${run.summary}\n${run.made}; axes: ${run.axes}` +
    (motion.time.length < run.rows ? `; ${motion.time.length} of ${run.rows} rows are shown` : "");

  let space;
  try {
    space = new Space(by("space"), by("labels"), run, motion, stale);
  } catch (error) {
    by("trouble").hidden = false;
    by("trouble").textContent = `This browser does not draw in three dimensions (WebGL): ${error.message}`;
    throw error;
  }
  const panel = new Panel(run, motion, by("kept").tBodies[0], by("chart"));

  // What can be chosen.
  const axes = [{ text: "inertial", kind: "inertial" }];
  if (motion.count > 1) axes.push({ text: "line of centres", kind: "line", body: 1 });
  for (const body of run.motion.turning.slice(0, 20)) axes.push({ text: `fixed in ${run.bodies[body].name}`, kind: "body", body });
  axes.forEach((one, i) => by("axes").add(new Option(one.text, i)));
  by("focus").add(new Option("barycentre", -1));
  run.bodies.slice(0, 200).forEach((body, i) => by("focus").add(new Option(body.name, i)));
  by("with-sun").hidden = !run.sunlight;
  const choose = (id, action) => by(id).addEventListener("change", () => { action(by(id)); stale(); });
  choose("axes", (select) => space.look(axes[Number(select.value)]));
  choose("focus", () => {});
  choose("trail", (select) => { space.trail = Number(select.value) === 0 ? 0 : Number(select.value) * run.period; });
  choose("size", (select) => { space.scale = Number(select.value); });
  choose("names", (box) => { by("labels").hidden = !box.checked; });
  choose("arrows", (box) => space.arrows(box.checked));
  choose("sun", (box) => space.sunlit(box.checked));
  by("home").addEventListener("click", () => space.camera.home(space.wholeView()));

  // Time. The speed is in halvings and doublings of a turn a second.
  const speed = () => run.period * 2 ** Number(by("speed").value);
  function go(time) {
    state.time = Math.min(end, Math.max(begin, time));
    stale();
  }
  function play(wanted) {
    state.playing = wanted && end > begin;
    if (state.playing && state.time >= end) go(begin);
    by("play").textContent = state.playing ? "\u23F8" : "\u25B6";
    by("play").setAttribute("aria-label", state.playing ? "Pause" : "Play");
    stale();
  }
  function step(rows) {
    const row = motion.rowAt(state.time), on = rows < 0 && motion.time[row] < state.time ? 1 : 0;
    go(motion.time[Math.min(motion.last, Math.max(0, row + rows + on))]);
  }
  function faster(by_) {
    by("speed").stepUp(by_);
    stale();
  }
  [by("scrub").min, by("scrub").max] = [begin, end];
  by("play").disabled = by("scrub").disabled = end <= begin;
  by("play").addEventListener("click", () => play(!state.playing));
  by("scrub").addEventListener("input", () => go(Number(by("scrub").value)));
  by("speed").addEventListener("input", stale);

  const keys = {
    " ": () => play(!state.playing),
    ArrowRight: (event) => step(event.shiftKey ? 10 : 1),
    ArrowLeft: (event) => step(event.shiftKey ? -10 : -1),
    ArrowUp: () => faster(2),
    ArrowDown: () => faster(-2),
    Home: () => go(begin),
    End: () => go(end),
    "+": () => space.camera.nearer(1.25),
    "=": () => space.camera.nearer(1.25),
    "-": () => space.camera.nearer(0.8),
    f: () => {
      by("axes").selectedIndex = (by("axes").selectedIndex + 1) % axes.length;
      by("axes").dispatchEvent(new Event("change"));
    },
  };
  document.addEventListener("keydown", (event) => {
    const own = event.target.closest("select, summary, input:not(#scrub), button"); // these have uses for keys
    if (event.ctrlKey || event.altKey || event.metaKey || !keys[event.key]) return;
    if (own && (event.key === " " || event.target.matches("select, #speed"))) return;
    event.preventDefault();
    keys[event.key](event);
  });

  function resized() {
    space.resize(by("stage").clientWidth, by("stage").clientHeight);
    stale();
  }
  new ResizeObserver(resized).observe(by("stage"));
  resized();
  space.camera.home(space.wholeView());
  document.querySelectorAll("details").forEach((one) => one.addEventListener("toggle", stale));

  function tick(now) {
    requestAnimationFrame(tick);
    const passed = Math.min(0.25, (now - state.before) / 1000);
    state.before = now;
    if (state.playing) {
      go(state.time + passed * speed());
      if (state.time >= end) play(false);
    }
    if (!state.stale) return;
    state.stale = false;
    state.drawn += 1;
    space.draw(state.time, Number(by("focus").value));
    panel.say(state.time);
    by("scrub").value = state.time;
    const date = run.epoch ? dateText(run.epoch, state.time) : "";
    by("clock").textContent = spanText(state.time) + (date ? `  (${date})` : "");
    by("scrub").setAttribute("aria-valuetext", by("clock").textContent);
    by("pace").textContent = `${spanText(speed())} a second`;
  }
  requestAnimationFrame(tick);
  window.viewer = { state, motion, space, play, go, step };
})();
