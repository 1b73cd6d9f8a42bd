"use strict";

// What draws on the reader's GPU is unpacked when it is needed: the laboratory when its view is shown, and the pictures of A and B
// when they are touched, or the run has none.
const laboratory = document.querySelector("#live"), pair = viewer?.pair, hasGpu = Boolean(window.WebGL2RenderingContext);
const once = (work) => {
  let done = null;
  return () => (done ??= work());
};
const readLive = once(async () => {
  const [script, data] = await Promise.all([unpacked("#live-script"), unpacked("#live-data")]);
  document.head.append(element("script", {}, script));
  takeLive(JSON.parse(data));
});
if (laboratory) {
  const say = (text) => (laboratory.querySelector("[data-live=said]").textContent = text);
  const open = once(() => readLive().then(() => openLaboratory(laboratory)).catch((error) => say(`The laboratory cannot be opened: ${error.message}.`)));
  if (!hasGpu) say("This browser does not support WebGL 2, which the laboratory needs.");
  else shows.push(({ view }) => view === laboratory.closest(".view").dataset.view && open());
}
if (laboratory && pair) {
  const enliven = once(() => readLive().then(() => pair.enliven()).catch((error) => {
    pair.isDrawable = false;
    pair.say(`These images are stills: ${error.message}.`);
    pair.show(state);
  }));
  if (hasGpu) {
    Object.assign(pair, { isDrawable: true, begin: enliven });
    pair.show(state);
    for (const touch of ["pointerdown", "focusin"]) pair.place.addEventListener(touch, enliven);
  } else pair.say("These images are stills: this browser does not support WebGL 2.");
}

// Everything that follows the state is there.
window.addEventListener("popstate", readAddress);
window.addEventListener("hashchange", readAddress);
readAddress();
