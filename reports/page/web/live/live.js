"use strict";

// The laboratory, once it is opened: its parts, one context for all of them, and what is said when that is lost.
async function openLaboratory(root, data) {
  live.root = root;
  live.data = data;
  for (const [at, codec] of data.codecs.entries()) codec.checks = data.sums[at];
  for (const codec of [...data.codecs, ...data.storages]) live.byLabel.set(codec.label, codec);
  const said = root.querySelector("[data-live=said]");
  try {
    live.device = new LiveDevice(root.querySelector("[data-live=canvas]"));
  } catch (error) {
    said.textContent = `The laboratory cannot run: ${error.message}.`;
    return;
  }
  live.device.on("lost", () => (said.textContent = "The browser took the GPU away from this page. The laboratory goes on when it is back."));
  live.device.on("restored", () => (said.textContent = "The GPU is back."));
  root.querySelector("[data-live=device]").textContent = `${live.device.renderer}; ${browserName()}`;
  for (const part of live.parts) await part(root);
  said.textContent = "";
  root.dataset.ready = "";
}
