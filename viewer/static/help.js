// The help as a dialog: the rest of the page is out of reach meanwhile, and the focus goes back to where it was.
(window.castrayParts ||= []).push(() => {
  const { ref, watch } = window.Vue;

  const Help = {
    props: ["open", "words"],
    emits: ["shut"],
    setup(props, { emit }) {
      const dialog = ref(null);
      watch(() => props.open, (open) => {
        if (open && !dialog.value.open) dialog.value.showModal();
        if (!open && dialog.value.open) dialog.value.close();
      });
      const shut = () => emit("shut");
      // the browser's own bars come next after the last control: here the first one does
      function turn(event) {
        const all = [...dialog.value.querySelectorAll("button, [tabindex='0']")], last = all.length - 1;
        const at = all.indexOf(document.activeElement), next = at + (event.shiftKey ? -1 : 1);
        all[next < 0 ? last : next > last ? 0 : next].focus();
      }
      const outside = (event) => { if (event.target === dialog.value) shut(); };
      return { dialog, shut, turn, outside };
    },
    template: `<dialog ref="dialog" class="help" role="dialog" aria-modal="true" aria-labelledby="help-head" data-testid="help" @close="shut" @click="outside" @keydown.tab.prevent="turn">
      <div class="between"><h2 id="help-head">{{ words.help }}</h2><button autofocus data-testid="help-close" :aria-label="words.close" :title="words.help_close" @click="shut"><castray-icon name="close"/></button></div>
      <div class="text" tabindex="0" role="region" :aria-label="words.help"><slot></slot></div></dialog>`,
  };

  return { CastrayHelp: Help };
});
