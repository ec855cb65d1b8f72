// Open: scenes by name, and files of one's own, sent to the server that gave the page.
(window.castrayParts ||= []).push(() => {
  const { ref } = window.Vue;

  const Open = {
    props: ["kinds", "limits", "words"],
    setup() {
      const box = ref(null), error = ref(""), busy = ref(false);
      async function send(event) {
        const field = event.target, file = field.files[0];
        if (!file) return;
        error.value = "";
        busy.value = true;
        try {
          const answer = await fetch(`open?name=${encodeURIComponent(file.name)}`, { method: "POST", body: file });
          if (answer.ok) box.value.open = false;
          else error.value = await answer.text();
        } catch (problem) { error.value = String(problem.message || problem); }
        busy.value = false;
        field.value = ""; // the same file may be chosen again
      }
      const shut = (event) => { if (event.target.closest("ul")) box.value.open = false; };
      return { box, error, busy, send, shut };
    },
    template: `<details ref="box" class="menu" data-testid="open" @keydown.esc="box.open = false"><summary>{{ words.open }}</summary><div @click="shut">
      <h2>{{ words.open_scenes }}</h2><slot></slot>
      <h2>{{ words.open_file }}</h2>
      <p><label class="choose">{{ words.open_choose }}<input type="file" :accept="kinds" :disabled="busy" data-testid="open-file" @change="send"></label></p>
      <p v-if="busy" role="status"><span class="busy" aria-hidden="true"></span>{{ words.open_busy }}</p>
      <p v-if="error" class="warning" role="alert" data-testid="open-error">{{ error }}</p>
      <p class="dim">{{ words.open_about }}</p><p v-for="l in limits" :key="l" class="dim">{{ l }}</p>
    </div></details>`,
  };

  return { CastrayOpen: Open };
});
