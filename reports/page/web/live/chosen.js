"use strict";

// The pictures of A and B in Choose, live: each is drawn whole, one after the other, where its still was.
// Pixels, degrees, and shares of the scene's own distance.
const CHOSEN_SIZE = [480, 360], OVER = [0, 85], AWAY = [0.3, 1.6];
const CHOSEN_LOOK = { shown: "studio", roughness: 0, bits: AS_STORED, isHalf: false, side: 0, above: 0, power: 1, full: 1, gain: 0 };

class Chosen extends Renderer {
  constructor(pair) {
    super(new LiveDevice(element("canvas", {})));
    Object.assign(this, { pair, size: CHOSEN_SIZE, at: 0, stills: [], orbit: new Orbit(this) });
    this.camera = { ...this.scenes.get(pair.scene).camera };
    this.restore();
    this.take();
  }

  // The stills that are there now, of codecs that the laboratory has.
  take() {
    this.stills = this.pair.stills.filter(({ name }) => live.byLabel.has(name));
    for (const { canvas } of this.stills) {
      canvas.dataset.live = "";
      // Its caption was that of the run's image.
      const caption = canvas.nextElementSibling;
      if (!caption.querySelector("mark")) caption.lastChild.replaceWith(caption.lastChild.textContent.replace(/: image$/, ": "), element("mark", {}, LIVE_TEXT));
      this.orbit.hold(canvas, canvas.closest("button"), true);
    }
    this.change();
  }

  get wanted() {
    const [left, right] = SIDES.map((_, at) => this.stills[at]?.name ?? EXACT);
    return { ...CHOSEN_LOOK, ...this.camera, subject: this.pair.scene, left, right, divider: this.at ? 0 : 1 };
  }

  async drawn(coarse) {
    for (const [at, { name, canvas }] of this.stills.entries()) {
      this.at = at;
      try {
        await super.drawn(coarse);
      } catch (error) {
        return this.pair.say(`This device cannot draw ${name}: ${error.message}`);
      }
      if (!this.device.isLost) canvas.getContext("2d").drawImage(this.canvas, 0, 0, canvas.width, canvas.height);
    }
  }

  turn(around, over) {
    const { camera } = this;
    this.aim({ around: camera.around + around, over: clamped(camera.over + over, ...OVER) });
  }

  nearer(by) {
    const { away } = this.scene.camera;
    this.aim({ away: clamped(this.camera.away * by, ...AWAY.map((share) => share * away)) });
  }

  aim(camera) {
    Object.assign(this.camera, camera);
    this.change();
  }
}
