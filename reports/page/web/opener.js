"use strict";

// The laboratory is unpacked and run when it is opened, or when the address names a part of it.
const laboratory = document.querySelector("#live");
if (laboratory && window.WebGL2RenderingContext) {
  laboratory.hidden = false;
  for (const link of document.querySelectorAll("nav [href='#live']")) link.parentNode.hidden = false;
  const details = laboratory.querySelector(".laboratory"), said = laboratory.querySelector("[data-live=said]");
  let opening = null;
  const open = async () => {
    const [script, data] = await Promise.all([unpacked("#live-script"), unpacked("#live-data")]);
    document.head.append(element("script", {}, script));
    await openLaboratory(laboratory, JSON.parse(data));
  };
  details.addEventListener("toggle", () => {
    if (details.open) opening ||= open().catch((error) => (said.textContent = `The laboratory cannot be opened: ${error.message}.`));
  });
  const shared = () => {
    if (!location.hash.startsWith("#live=")) return;
    details.open = true;
    laboratory.scrollIntoView();
  };
  window.addEventListener("hashchange", shared);
  shared();
}
