// The tab of the browser: who leads, the link in its address, its language, and the keys.
(window.castrayParts ||= []).push(() => {
  const { inject, onMounted, watch } = window.Vue;
  const self = Math.random().toString(36).slice(2) + Date.now().toString(36);

  const RESTS = 1000; // milliseconds after the last step that the reader rests
  const CHOSEN = "castray-language"; // where the browser keeps it

  // One tab at a time: this one asks to lead, follows the link in its address, and hears the keys.
  const Tab = {
    props: ["owner", "link", "x", "y", "keys", "language", "languages"], // keys: {key: [call, arguments...]}
    setup(props) {
      const trame = inject("trame"), mine = () => props.owner === self;
      const take = () => trame.trigger("take", [self, "", wanted()]);
      // the language that was chosen in this browser before, or the first of its own that is known here
      function wanted() {
        const known = props.languages.map((l) => l.tag);
        const tags = [localStorage.getItem(CHOSEN), ...navigator.languages].filter(Boolean);
        return tags.map((tag) => tag.toLowerCase().split("-")[0]).find((tag) => known.includes(tag)) || props.language;
      }
      function speak(tag) { localStorage.setItem(CHOSEN, tag); trame.trigger("speak", [tag]); }
      const typing = (event) => /^(INPUT|TEXTAREA|SELECT)$/.test(event.target.tagName);
      function key(event) {
        if (!mine() || typing(event) || event.ctrlKey || event.altKey || event.metaKey) return;
        const named = (event.shiftKey && props.keys["Shift+" + event.key]) || props.keys[event.key];
        const asking = !!document.querySelector("dialog[open]"), help = named && named[0] === "help";
        const pressed = event.key === " " && /^(BUTTON|SUMMARY)$/.test(event.target.tagName);
        if (!named || (asking && !help) || pressed) return;
        const [name, ...given] = named;
        let call = [name, given];
        if (name === "beside") call = ["pick", [props.x + given[0], props.y + given[1]]];
        if (name === "look") trame.state.set("tab", given[0]);
        event.preventDefault();
        event.stopPropagation();
        if (help) trame.state.set("helped", !asking);
        else trame.trigger(...call);
      }
      const hush = (event) => { if (!typing(event)) event.stopPropagation(); }; // vtk.js binds w, s and r
      const follow = () => { const hash = window.location.hash.slice(1); if (mine() && hash && hash !== props.link) trame.trigger("open", [hash]); };
      const write = () => { if (mine() && window.location.hash.slice(1) !== props.link) window.history.replaceState(null, "", "#" + props.link); };
      // a new address costs the browser two pictures of the page and the icon's: it is written when the reader rests, or
      // reaches for it; a scroll costs one, and is rarely needed
      let writing = 0;
      const writeSoon = () => { clearTimeout(writing); writing = setTimeout(write, RESTS); };
      const reaching = (event) => { if (event.ctrlKey || event.metaKey || /^F\d/.test(event.key)) write(); };
      const leaving = (event) => { if (event.target.closest("a[href^='#']")) write(); }; // a link to the address that stands there would lead nowhere
      function reveal(element) {
        const box = element.getBoundingClientRect(), frame = element.closest(".events, .track").getBoundingClientRect();
        const hidden = box.top < frame.top + (element.tagName === "TR" ? 24 : 0) || box.bottom > frame.bottom || box.left < frame.left || box.right > frame.right + 1;
        if (hidden) element.scrollIntoView({ block: "nearest", inline: "nearest" });
      }
      const show = () => { document.querySelectorAll(".events [aria-current], .track [aria-current]").forEach(reveal); };
      onMounted(async () => {
        window.addEventListener("keydown", key, true);
        window.addEventListener("keydown", reaching, true);
        window.addEventListener("click", leaving, true);
        window.addEventListener("blur", write);
        document.documentElement.addEventListener("pointerleave", write);
        for (const kind of ["keypress", "keyup"]) window.addEventListener(kind, hush, true);
        window.addEventListener("hashchange", follow);
        const asked = window.location.hash.slice(1);
        await trame.trigger("take", [self, asked, wanted()]);
        document.documentElement.dataset.ready = "true";
      });
      watch(() => [props.link, props.owner], () => { writeSoon(); queueMicrotask(show); }, { flush: "post" }); // after the 3D view has been drawn
      watch(() => props.language, (tag) => { document.documentElement.lang = tag; }, { immediate: true });
      return { mine, take, speak };
    },
    template: `<slot :mine="mine()" :take="take" :speak="speak"></slot>`,
  };

  return { CastrayTab: Tab };
});
