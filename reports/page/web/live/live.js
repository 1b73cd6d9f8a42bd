"use strict";

// What is done once the laboratory's data is there. `openLaboratory` makes its parts, one context for all of them, and says when
// that is lost.
function takeLive(data) {
  live.data = data;
  for (const [at, codec] of data.codecs.entries()) codec.checks = data.sums[at];
  for (const codec of [...data.codecs, ...data.storages]) live.byLabel.set(codec.label, codec);
}

async function openLaboratory(root) {
  live.root = root;
  const said = root.querySelector("[data-live=said]");
  try {
    live.device = new LiveDevice(root.querySelector("[data-live=canvas]"));
  } catch (error) {
    said.textContent = `The laboratory cannot run: ${error.message}.`;
    return;
  }
  live.device.on("lost", () => (said.textContent = "The browser has taken the GPU from this page. The laboratory continues when the GPU is back."));
  live.device.on("restored", () => (said.textContent = "The GPU is back."));
  root.querySelector("[data-live=device]").textContent = `${live.device.renderer}; ${browserName()}`;
  for (const part of live.parts) await part(root);
  said.textContent = "";
  root.dataset.ready = "";
}
