"use strict";
// From where one looks: turned about a point by dragging, nearer by scrolling or by pinching.

class Camera {
  constructor(canvas, changed) {
    this.eye = new THREE.PerspectiveCamera(35, 1, 0.001, 1e5);
    this.target = new THREE.Vector3();
    this.up = new THREE.Vector3(0, 0, 1);
    this.changed = changed;
    [this.azimuth, this.elevation, this.distance] = [0, 0, 1];
    this.pointers = new Map();
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      this.pointers.set(event.pointerId, event);
    });
    for (const end of ["pointerup", "pointercancel"]) {
      canvas.addEventListener(end, (event) => this.pointers.delete(event.pointerId));
    }
    canvas.addEventListener("pointermove", (event) => this.moved(event));
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.nearer(Math.exp(-0.0015 * event.deltaY));
    }, { passive: false });
  }

  // Look at everything from a little above the plane.
  home(distance) {
    this.azimuth = -1.1;
    this.elevation = 0.6;
    this.distance = distance;
    this.changed();
  }

  nearer(factor) {
    this.distance = Math.min(1e4, Math.max(1e-4, this.distance / factor));
    this.changed();
  }

  moved(event) {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const apart = () => {
      const [a, b] = [...this.pointers.values()];
      return Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY);
    };
    const old = this.pointers.size === 2 ? apart() : 0;
    this.pointers.set(event.pointerId, event);
    if (old > 0) {
      this.nearer(apart() / old);
      return;
    }
    this.azimuth -= 0.006 * (event.clientX - before.clientX);
    this.elevation += 0.006 * (event.clientY - before.clientY);
    this.elevation = Math.min(1.55, Math.max(-1.55, this.elevation));
    this.changed();
  }

  // Put the eye where the angles say, about the pole of what is shown.
  place() {
    const first = new THREE.Vector3(1, 0, 0);
    if (Math.abs(this.up.x) > 0.9) first.set(0, 1, 0);
    first.addScaledVector(this.up, -first.dot(this.up)).normalize();
    const second = this.up.clone().cross(first);
    const along = Math.cos(this.elevation);
    this.eye.position.copy(this.target)
      .addScaledVector(first, this.distance * along * Math.cos(this.azimuth))
      .addScaledVector(second, this.distance * along * Math.sin(this.azimuth))
      .addScaledVector(this.up, this.distance * Math.sin(this.elevation));
    this.eye.up.copy(this.up);
    this.eye.near = this.distance / 1e3;
    this.eye.far = this.distance * 1e4;
    this.eye.lookAt(this.target);
    this.eye.updateProjectionMatrix();
    this.eye.updateMatrixWorld();
  }
}
