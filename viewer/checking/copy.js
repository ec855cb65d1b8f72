// A button beside a command takes it along: to the clipboard where a page may, and selected, for whoever may not.
for (const button of document.querySelectorAll("button[data-copied]")) {
  button.addEventListener("click", async () => {
    const command = button.previousElementSibling;
    getSelection().selectAllChildren(command);
    try { await navigator.clipboard.writeText(command.textContent); button.textContent = button.dataset.copied; } catch { /* it stays selected */ }
  });
}
