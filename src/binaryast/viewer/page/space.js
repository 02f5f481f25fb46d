"use strict";
// What is drawn: the bodies, their paths, their names, and the light.

const MOST_PATHS = 40, LONGEST_PATH = 60000, MOST_NAMES = 12;
const SMALLEST = 2; // pixels: what is smaller is shown as a dot

// A sphere's map: lines each 30 degrees, the one through the x axis stronger, so that its turning is seen.
function graticule() {
  const sheet = document.createElement("canvas");
  [sheet.width, sheet.height] = [1024, 512];
  const pen = sheet.getContext("2d");
  pen.fillStyle = "#ffffff";
  pen.fillRect(0, 0, 1024, 512);
  pen.fillStyle = "rgba(0, 0, 0, 0.13)";
  for (let i = 0; i < 12; i++) for (let j = i % 2; j < 6; j += 2) pen.fillRect(i * 1024 / 12, j * 512 / 6, 1024 / 12, 512 / 6);
  pen.fillStyle = "rgba(0, 0, 0, 0.45)";
  pen.fillRect(509, 0, 6, 512);
  pen.fillRect(0, 254, 1024, 4);
  const map = new THREE.CanvasTexture(sheet);
  map.anisotropy = 4;
  return map;
}

function solidOf(solid, material, sphere, map) {
  if (solid.vertices) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(Motion.unpacked(solid.vertices, Float32Array), 3));
    geometry.setIndex(new THREE.BufferAttribute(Motion.unpacked(solid.faces, Uint32Array), 1));
    return new THREE.Mesh(geometry, material({ flatShading: true }));
  }
  if (solid.rod) {
    const geometry = new THREE.BufferGeometry().setFromPoints(solid.rod.map((end) => new THREE.Vector3(...end)));
    return new THREE.Line(geometry, new THREE.LineBasicMaterial({ color: 0xa9a7a2 }));
  }
  if (solid.balls) {
    const places = Motion.unpacked(solid.balls, Float32Array), radii = Motion.unpacked(solid.radii, Float32Array);
    const ball = new THREE.SphereGeometry(1, 16, 10);
    const many = new THREE.InstancedMesh(ball, material({}), radii.length);
    const matrix = new THREE.Matrix4();
    radii.forEach((r, i) => {
      matrix.makeScale(r, r, r).setPosition(places[3 * i], places[3 * i + 1], places[3 * i + 2]);
      many.setMatrixAt(i, matrix);
    });
    many.frustumCulled = false;
    return many;
  }
  const mesh = new THREE.Mesh(sphere, material({ map }));
  const m = solid.matrix, [x, y, z] = solid.centre;
  mesh.matrixAutoUpdate = false;
  mesh.matrix.set(m[0], m[1], m[2], x, m[3], m[4], m[5], y, m[6], m[7], m[8], z, 0, 0, 0, 1);
  return mesh;
}

class Space {
  constructor(canvas, labels, run, motion, changed) {
    this.canvas = canvas;
    this.run = run;
    this.motion = motion;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true });
    this.renderer.setClearColor(0x101318);
    this.scene = new THREE.Scene();
    this.camera = new Camera(canvas, changed);
    this.world = new THREE.Group(); // in inertial axes
    this.scene.add(this.world);
    this.scale = 1;
    this.addLights();
    this.addBodies();
    this.addPoints();
    this.addPaths();
    this.addNames(labels);
    this.extent = Math.max(...run.bodies.map((body, i) => body.reach + Motion.size(motion.at(motion.time[0], i).place)));
    this.look({ kind: "inertial" });
  }

  wholeView() {
    const narrow = Math.min(1, this.camera.eye.aspect);
    return (1.05 * Math.max(this.extent, 1)) / Math.sin((this.camera.eye.fov * Math.PI) / 360) / narrow;
  }

  addLights() {
    this.around = new THREE.AmbientLight(0xffffff, 0.3);
    this.lamp = new THREE.DirectionalLight(0xffffff, 0.75); // beside the eye
    this.sun = new THREE.DirectionalLight(0xfff4e0, 1.0);
    this.scene.add(this.around, this.lamp, this.lamp.target);
    this.world.add(this.sun, this.sun.target);
    this.directions = this.run.sunlight ? Motion.unpacked(this.run.sunlight, Float32Array) : null;
    this.sunlit(Boolean(this.directions));
  }

  sunlit(wanted) {
    this.sun.visible = wanted && Boolean(this.directions);
    this.lamp.visible = !this.sun.visible;
    this.around.intensity = this.sun.visible ? 0.12 : 0.3;
  }

  addBodies() {
    const sphere = new THREE.SphereGeometry(1, 64, 40).rotateX(Math.PI / 2), map = graticule();
    this.bodies = this.run.bodies.map((body) => {
      if (!body.solids.length) return null;
      const material = (options) => new THREE.MeshPhongMaterial({ color: lighter(body.colour), shininess: 4, specular: 0x111111, ...options });
      const group = new THREE.Group();
      for (const solid of body.solids) group.add(solidOf(solid, material, sphere, map));
      const arrows = new THREE.AxesHelper(1.5 * body.reach);
      arrows.visible = false;
      group.add(arrows);
      group.userData.arrows = arrows;
      this.world.add(group);
      return group;
    });
  }

  // Bodies without a size, or too small to be seen, are dots, all of them one object.
  addPoints() {
    const { length } = this.run.bodies, geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * length), 3));
    geometry.setAttribute("color", new THREE.BufferAttribute(new Float32Array(3 * length), 3));
    this.colours = this.run.bodies.map((body) => new THREE.Color(lighter(body.colour)).toArray());
    const size = length > 50 ? 2.5 : 5;
    this.points = new THREE.Points(geometry, new THREE.PointsMaterial({ size, sizeAttenuation: false, vertexColors: true }));
    this.points.frustumCulled = false;
    this.world.add(this.points);
  }

  addPaths() {
    const { motion } = this;
    this.paths = this.run.bodies.slice(0, MOST_PATHS).map((body) => {
      const material = new THREE.LineBasicMaterial({ color: lighter(body.colour), transparent: true, opacity: 0.75 });
      const line = new THREE.Line(new THREE.BufferGeometry(), material);
      line.frustumCulled = false;
      this.scene.add(line);
      return line;
    });
    // So many parts of each interval that paths look round, as far as there is room.
    const usual = (motion.time[motion.last] - motion.time[0]) / Math.max(1, motion.last);
    const wanted = Math.ceil((60 * usual) / this.run.period);
    const parts = Math.max(1, Math.min(wanted, 60, Math.floor(LONGEST_PATH / this.paths.length / (motion.last + 1))));
    const times = [];
    for (let k = 0; k < motion.last; k++) {
      const h = motion.time[k + 1] - motion.time[k];
      for (let j = 0; j < (h > 0 ? parts : 1); j++) times.push(motion.time[k] + (h * j) / parts);
    }
    times.push(motion.time[motion.last]);
    this.pathTimes = Float64Array.from(times);
    this.trail = this.run.period;
  }

  addNames(labels) {
    this.names = this.run.bodies.slice(0, MOST_NAMES).map((body) => {
      const label = document.createElement("span");
      label.textContent = body.name;
      label.style.color = lighter(body.colour);
      labels.append(label);
      return label;
    });
  }

  // Show everything from other axes: paths are made anew, for their shape depends on it.
  look(axes) {
    const { motion } = this;
    this.axes = axes;
    this.camera.up.set(...(axes.kind === "inertial" ? this.run.pole : [0, 0, 1]));
    const frames = Array.from(this.pathTimes, (t) => motion.shown(t, axes));
    this.paths.forEach((line, body) => {
      const places = new Float32Array(3 * (frames.length + 1)); // the last one is for where the body is
      frames.forEach((frame, k) => {
        places.set(Motion.turned(frame.turn, Motion.minus(motion.at(this.pathTimes[k], body).place, frame.origin)), 3 * k);
      });
      line.geometry.setAttribute("position", new THREE.BufferAttribute(places, 3));
      line.userData.all = places.slice();
    });
  }

  // Bring a path to a time: its end is moved to where the body is.
  drawPath(line, t, place) {
    const all = line.userData.all, attribute = line.geometry.attributes.position;
    const begin = before(this.pathTimes, t - this.trail) + 1, end = before(this.pathTimes, t) + 1;
    if (line.userData.end >= 0) {
      const old = 3 * line.userData.end;
      attribute.array.set(all.subarray(old, old + 3), old);
    }
    attribute.array.set(place, 3 * end);
    line.userData.end = end;
    attribute.needsUpdate = true;
    line.geometry.setDrawRange(begin, Math.max(0, end - begin + 1));
    line.visible = this.trail > 0;
  }

  draw(t, focus) {
    const { motion } = this, frame = motion.shown(t, this.axes);
    const seen = this.run.bodies.map((_, i) => {
      const { place } = motion.at(t, i), group = this.bodies[i];
      if (group) {
        group.position.set(...place);
        group.quaternion.set(...motion.attitude(t, i));
        group.scale.setScalar(this.scale);
      }
      return { place, shown: Motion.turned(frame.turn, Motion.minus(place, frame.origin)) };
    });
    this.world.quaternion.set(...frame.turn);
    this.world.position.set(...Motion.turned(frame.turn, frame.origin)).negate();
    this.paths.forEach((line, i) => this.drawPath(line, t, seen[i].shown));
    const middle = Motion.turned(frame.turn, Motion.minus([0, 0, 0], frame.origin));
    this.camera.target.set(...(focus < 0 ? middle : seen[focus].shown));
    this.camera.place();
    this.drawDots(seen);
    this.lamp.position.copy(this.camera.eye.position);
    this.lamp.target.position.copy(this.camera.target);
    if (this.directions) this.sun.position.fromArray(this.directions, 3 * motion.rowAt(t));
    this.renderer.render(this.scene, this.camera.eye);
    this.placeNames(seen.map((one) => one.shown));
  }

  drawDots(seen) {
    const { position, color } = this.points.geometry.attributes;
    let count = 0;
    seen.forEach(({ place, shown }, i) => {
      if (this.bodies[i] && this.pixels(i, shown) > SMALLEST) return;
      position.setXYZ(count, ...place);
      color.setXYZ(count, ...this.colours[i]);
      count += 1;
    });
    this.points.geometry.setDrawRange(0, count);
    position.needsUpdate = color.needsUpdate = true;
  }

  // How far a body reaches from its mass centre on the screen.
  pixels(body, shown) {
    const away = this.camera.eye.position.distanceTo(new THREE.Vector3(...shown));
    const share = (this.scale * this.run.bodies[body].reach) / (2 * away * Math.tan((this.camera.eye.fov * Math.PI) / 360));
    return share * this.canvas.clientHeight;
  }

  placeNames(places) {
    const { clientWidth: width, clientHeight: height } = this.canvas, point = new THREE.Vector3();
    this.names.forEach((label, i) => {
      const lift = this.pixels(i, places[i]);
      point.set(...places[i]).project(this.camera.eye);
      label.hidden = Math.abs(point.z) > 1;
      const x = ((point.x + 1) * width) / 2, y = ((1 - point.y) * height) / 2 - Math.min(lift, height / 3) - 6;
      label.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px) translate(-50%, -100%)`;
    });
  }

  arrows(wanted) {
    for (const group of this.bodies) if (group) group.userData.arrows.visible = wanted;
  }

  resize(width, height) {
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.camera.eye.aspect = width / Math.max(1, height);
  }
}

// Colours are those of the pictures, which are made for paper: here they stand on a dark ground.
function lighter(colour) {
  const shade = new THREE.Color(colour), { h, s, l } = shade.getHSL({});
  return `#${shade.setHSL(h, s, Math.max(l, 0.62)).getHexString()}`;
}

// The index of the last of times that grow which is before t; -1 where none is.
function before(times, t) {
  let low = -1, high = times.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (times[middle] < t) low = middle; else high = middle - 1;
  }
  return low;
}
