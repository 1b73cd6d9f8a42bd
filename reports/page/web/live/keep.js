"use strict";

// "Keep it": what was measured, as a file that `normalbench import` reads.

const DEVICE_FORMAT = 1;

function deviceFile({ device, data, rows, facts }) {
  return {
    normalbench_device: DEVICE_FORMAT,
    renderer: String(device.renderer),
    vendor: String(device.vendor),
    browser: navigator.userAgent,
    made: new Date().toISOString().replace(/\.\d+Z$/, "Z"),
    program: data.program,
    sources: data.sources,
    codecs: rows,
    facts,
  };
}

function deviceName(renderer) {
  const slug = String(renderer).toLowerCase().replace(/[^a-z0-9]+/g, "-").replace(/^-+|-+$/g, "");
  // Whole words of it, without the layer that draws.
  const words = slug.split("-").filter((word) => !["angle", "google", "inc"].includes(word)).slice(0, 6).join("-");
  return `normalbench-${words.slice(0, 60) || "device"}.json`;
}

// A button that saves the device, and the command that adds it to a run.
function keepDevice(root, measured) {
  const name = deviceName(measured.device.renderer), said = element("span", { role: "status" });
  const saved = () => {
    const href = URL.createObjectURL(new Blob([JSON.stringify(deviceFile(measured), null, 1) + "\n"], { type: "application/json" }));
    save(name, href);
    setTimeout(() => URL.revokeObjectURL(href), 1000);
    said.textContent = `Saved as ${name}`;
  };
  const button = element("button", { type: "button", "data-save": "", onclick: saved }, "Save this device");
  const command = element("code", {}, `normalbench import ${name} -o RUN`);
  const note = element("p", { class: "note" }, "Add it to a run, where RUN is the run's folder: ", command);
  root.replaceChildren(element("p", { class: "tools" }, button, said), note);
}
