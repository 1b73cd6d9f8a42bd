"use strict";

// The laboratory is unpacked and run when its view is shown.
const laboratory = document.querySelector("#live");
if (laboratory && !window.WebGL2RenderingContext) laboratory.querySelector("[data-live=said]").textContent = "This browser has no WebGL2, which the laboratory needs.";
if (laboratory && window.WebGL2RenderingContext) {
  let opening = null;
  const open = async () => {
    const [script, data] = await Promise.all([unpacked("#live-script"), unpacked("#live-data")]);
    document.head.append(element("script", {}, script));
    await openLaboratory(laboratory, JSON.parse(data));
  };
  shows.push(({ view }) => {
    if (view !== laboratory.closest(".view").dataset.view) return;
    opening ||= open().catch((error) => (laboratory.querySelector("[data-live=said]").textContent = `The laboratory cannot be opened: ${error.message}.`));
  });
}

// Everything that follows the state is there.
window.addEventListener("popstate", readAddress);
window.addEventListener("hashchange", readAddress);
readAddress();
