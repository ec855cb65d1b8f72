// A lesson beside the scene: it stays where it was read, marks the place one is at, and takes answers.
(window.castrayParts ||= []).push(() => {
  const { onBeforeUnmount, onMounted, onUpdated, ref, watch } = window.Vue;
  const kept = {}; // how far each lesson was scrolled

  const Reading = {
    props: ["number", "link"],
    setup(props) {
      const box = ref(null), frame = () => box.value.closest(".tabbody");
      let scrolled = kept[props.number] || 0;
      function mark() {
        for (const anchor of box.value.querySelectorAll("a[href^='#scene=']")) {
          if (anchor.getAttribute("href").slice(1) === props.link) anchor.setAttribute("aria-current", "true");
          else anchor.removeAttribute("aria-current");
        }
        if (scrolled && frame().scrollHeight > scrolled) { frame().scrollTop = scrolled; scrolled = 0; } // as soon as the text is there
      }
      onMounted(() => { frame().scrollTop = 0; mark(); });
      onUpdated(mark);
      watch(() => props.link, mark, { flush: "post" });
      onBeforeUnmount(() => { kept[props.number] = scrolled || frame().scrollTop; });
      return { box };
    },
    template: `<article ref="box"><slot></slot></article>`,
  };

  const Answer = {
    props: ["task", "words", "bugs", "place"],
    emits: ["answer"],
    setup(props, { emit }) {
      const said = ref("");
      const send = () => emit("answer", String(said.value));
      return { said, send };
    },
    template: `<form class="answer" @submit.prevent="send"><template v-if="task.kind === 'choice'">
        <label v-for="c in task.choices" :key="c.id" class="choice"><input type="radio" :name="task.id" :value="c.id" v-model="said" :data-testid="'answer-' + task.id + '-' + c.id">
          <b>{{ c.id }})</b><span class="prose" v-html="c.html"></span></label></template>
      <select v-else-if="task.kind === 'bug'" v-model="said" :aria-label="words.lesson_which_bug" :data-testid="'answer-' + task.id"><option value="">{{ words.lesson_which_bug }}</option>
        <optgroup v-for="f in bugs" :key="f.family" :label="f.family"><option v-for="b in f.bugs" :key="b.id" :value="b.id">{{ b.id }} {{ b.title }}</option></optgroup></select>
      <label v-else-if="task.kind === 'number'" class="typed"><input v-model="said" type="text" autocomplete="off" spellcheck="false" maxlength="100" :aria-label="words.lesson_number" :placeholder="words.lesson_number" :data-testid="'answer-' + task.id"> {{ task.unit }}</label>
      <a v-if="task.place" :href="task.there" :data-testid="'there-' + task.id">{{ words.lesson_there }}</a>
      <button class="check" :disabled="task.busy || (!task.place && !said)" :data-testid="'check-' + task.id">{{ task.place ? words['lesson_this_' + task.kind] + ' ' + place : words.lesson_check }}</button></form>`,
  };

  return { CastrayReading: Reading, CastrayAnswer: Answer };
});
