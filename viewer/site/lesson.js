// Links in the text turn the picture and the paths beside it to the place they speak of.
(() => {
  const data = JSON.parse(document.getElementById("paths").textContent);
  const view = castrayView(document.querySelector(".castray-3d"), data);
  const commands = document.getElementById("commands").content;
  function turn() {
    const name = window.location.hash.replace(/^#place-/, ""), found = data.places.findIndex((place) => place.name === name);
    const place = found < 0 ? data.start : found;
    if (found < 0 && window.location.hash) return; // a place of the text: a task, a formula
    view.show(place);
    const aside = document.querySelector("aside");
    if (found >= 0 && getComputedStyle(aside).position === "static") aside.scrollIntoView({ block: "nearest" }); // not beside the text
    document.getElementById("command").textContent = commands.getElementById(data.places[place].name).textContent;
    for (const link of document.querySelectorAll("a[href^='#place-']")) {
      if (link.hash === `#place-${data.places[place].name}`) link.setAttribute("aria-current", "true");
      else link.removeAttribute("aria-current");
    }
  }
  // the same link again: back from where one has walked to
  document.addEventListener("click", (event) => { const link = event.target.closest("a[href^='#place-']"); if (link && link.hash === window.location.hash) turn(); });
  window.addEventListener("hashchange", turn);
  turn();
})();
