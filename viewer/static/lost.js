// When the server does not answer any more: says so over whatever is left of the page, and goes on when it is back.
(() => {
  const EVERY = 1500; // milliseconds
  let words = {}, command = "", box = null;

  // what the page was told last; it has nothing to say once the connection is closed
  function remember() {
    const state = window.trame && window.trame.state;
    if (!state || !state.get("w")) return;
    words = state.get("w");
    command = (state.get("share") || {}).again || "castray view";
  }

  // it may have ended, or have been started again under a new key, which this browser has not got yet
  async function answers() {
    try { return (await fetch("castray/icon.svg", { method: "HEAD", cache: "no-store" })).ok; } catch { return false; }
  }

  function line(tag, text) {
    const element = document.createElement(tag);
    element.textContent = text;
    if (tag === "code") element.className = "command";
    return element;
  }

  function show() {
    box = document.createElement("div");
    Object.assign(box, { className: "takeover", role: "alertdialog", ariaLabel: words.lost, tabIndex: -1 });
    box.dataset.testid = "lost";
    const inner = document.createElement("div");
    inner.append(line("h2", words.lost), line("p", words.lost_start), line("code", `${command} --port ${window.location.port}`), line("p", words.lost_about));
    box.append(inner);
    document.getElementById("app").hidden = true; // what trame puts there instead
    document.body.append(box);
    box.focus();
  }

  async function look() {
    if (!box) remember();
    const there = await answers();
    if (box && there) { window.location.reload(); return; } // the address still holds the link
    if (!box && !there && words.lost) show();
    setTimeout(look, EVERY);
  }
  setTimeout(look, EVERY);
})();
