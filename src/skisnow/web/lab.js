// The browser's side of every page. Fields are open only while the lab answers, Enter moves the focus here and not by way
// of the server; keys typed before an answer are held and then go to the field with the focus.
(() => {
  "use strict";

  const HELD = ["Enter", "Backspace", "Tab"]; // besides all keys that write a letter
  const PATIENCE_MS = 150000; // an answer that has not come by then is not coming: the connection is given up before
  const CONNECT_MS = 90000; // time after which the framework reloads the page if the lab has not answered
  const PAUSE_MS = 250; // a hand that types on is quicker, one that has seen a refusal is slower
  const { language, words } = document.currentScript.dataset;
  const SAID = JSON.parse(words); // texts of this script in the language of the page
  const held = []; // keys typed while an answer is on its way
  let waiting = "ahead" in document.currentScript.dataset; // the page itself is the first answer, number 0
  let refused = false; // outcome of the last request
  let writing = false; // held keys are being written, or after a refusal let run out
  let own = false; // this very letter is written here
  let asked = 0; // number of the last question
  let timer = 0;
  let watched = false;
  let left = null; // the field in which the connection was lost
  let isLost = false;
  let again = null; // asks once more what was asked last
  let resuming = false; // readings or rows of before are being told to the lab
  let goingTo = ""; // the address that the page goes on to
  let drawings = 0; // menus with a choice whose fields are not drawn again yet
  let toPutRight = null; // the field of the last reading, which was refused
  const telling = new Map(); // readings that the lab has not answered yet, by their numbers

  // loads as the mass of the discs in kg, remembered by the browser
  const IN_KG = "skisnow-loads-in-kg";
  if (localStorage.getItem(IN_KG)) document.documentElement.classList.add("in-kg");
  document.addEventListener("click", (event) => {
    if (event.target.closest?.(".switch-kg")) {
      const isKg = document.documentElement.classList.toggle("in-kg");
      if (isKg) localStorage.setItem(IN_KG, "1");
      else localStorage.removeItem(IN_KG);
    }
    const menu = event.target.closest?.(".lab-head .menu");
    if (menu) menu.setAttribute("aria-expanded", String(menu.closest(".lab-head").classList.toggle("open")));
  });

  const fieldsets = () => document.querySelectorAll("fieldset.lab");

  // The connection

  async function connected() {
    if (isLost) await goneOn();
    isLost = false;
    fieldsets().forEach((each) => (each.disabled = false));
    document.documentElement.classList.remove("not-connected");
    if (left?.isConnected) left.focus();
    left = null;
    if (!watched) begun();
    if (held.length && !writing && !resuming) writeHeld();
  }

  function begun() {
    watched = true;
    window.socket.on("disconnect", lost);
    window.socket.io.timeout(CONNECT_MS);
    resuming = tellKept();
    if (!resuming && !waiting) resume();
  }

  // Send kept readings or rows first; the lab answers with `resent` or `grown`. Returns true if there were any.
  function tellKept() {
    const form = kept.missing();
    const unanswered = kept.readings();
    if (form) emitEvent("grow", form);
    else if (unanswered.length) emitEvent("resent", unanswered);
    return Boolean(form || unanswered.length);
  }

  // Requests sent when the connection was lost may be lost: send them again, the lab knows each key.
  async function goneOn() {
    await kept.tellAgain();
    telling.forEach((emit) => emit());
    if (resuming && !tellKept()) grown();
    if (waiting) again?.();
    if (drawings) open();
  }

  function lost() {
    isLost = true;
    left = document.activeElement;
    save();
    left?.blur?.();
    fieldsets().forEach((each) => (each.disabled = true));
    document.documentElement.classList.add("not-connected");
    say("connection", SAID.lost);
  }

  // Answers to readings that were sent again; those that were not stored are shown in full.
  function resent(answers) {
    if (!resuming) return; // asked twice
    answers.forEach(([number]) => kept.settled(number));
    resumed(answers.map(([, why]) => why).filter(Boolean));
  }

  // The form has the rows again that it had before the reload.
  function grown() {
    if (resuming) resumed([]);
  }

  function resumed(refusals) {
    resuming = false;
    if (!waiting || asked === 0) resume(refusals);
  }

  // Texts typed before the reload go to their fields or are shown.
  async function resume(refusals = []) {
    const before = kept.restore();
    if (before.held.length && (before.ready || before.ahead)) held.unshift(...before.held);
    else if (before.held.length) before.without.push(before.held.map(inWords).join(""));
    if (before.without.length) refusals.push(`${SAID.before} ${before.without.join("; ")}`);
    if (refusals.length) say("unused", refusals.join(" "));
    await pause(0); // the fields send restored texts before a key arrives
    waiting = false;
    refused = false;
    if (!writing) writeHeld();
  }

  // Enter in a form is not done before it is answered: after a reload it is pressed again, and stored once. So it is on
  // a button that adds a row.
  function save() {
    if (goingTo) return kept.handOn(goingTo, held);
    const pressed = waiting && again?.kind ? ["Enter"] : [];
    kept.save({ held: [...pressed, ...held], ahead: !watched }, left ?? document.activeElement);
  }

  function say(place, words) {
    const line = document.querySelector(`.lab-says .${place}`);
    if (line) line.textContent = words;
  }

  // What is typed on while an answer is on its way

  function isHeld(event) {
    return (waiting || writing || isLost || goingTo || drawings) && event.isTrusted && !event.target.closest?.("a, summary");
  }

  function keyPressed(event) {
    const writes = event.key.length === 1 || HELD.includes(event.key);
    if (!writes || event.ctrlKey || event.metaKey || event.altKey || !isHeld(event)) return;
    if (event.key === "Tab" && !held.length && (!watched || isLost)) return; // no way out of a page that never opens else
    event.preventDefault();
    event.stopImmediatePropagation();
    held.push(event.key === "Tab" && event.shiftKey ? "Back" : event.key);
    save();
  }

  function textComes(event) {
    // keyboards on glass tell no key
    if (own || !isHeld(event)) return;
    event.preventDefault();
    if (event.data) held.push(...event.data);
    save();
  }

  // `kind`: "enter" in a form, "row" where a row is added and nothing stored.
  function ask(emit, kind = "") {
    if (waiting || goingTo) return; // pressed twice
    waiting = true;
    tellHolding();
    asked += 1;
    say("unused", "");
    const number = asked;
    timer = setTimeout(giveUp, PATIENCE_MS);
    const once = kept.once();
    again = () => emit({ number, once });
    again.kind = kind;
    again();
    save();
  }

  function giveUp() {
    if (isLost) timer = setTimeout(giveUp, PATIENCE_MS); // it is asked again when the lab is back
    else answered(asked, false);
  }

  function answered(number, fine) {
    if (number !== asked) return; // an outdated answer
    if (number === 0) return resuming || resume();
    clearTimeout(timer);
    waiting = false;
    refused = !fine;
    if (fine && again.kind !== "row") kept.done();
    save();
    if (!writing) writeHeld();
  }

  // A choice in a menu draws the fields below again: they are disabled until then, and keys are held.
  function drawAnew(emit) {
    drawings += 1;
    close(true);
    tellHolding();
    emit();
  }

  function drawn() {
    drawings = Math.max(0, drawings - 1);
    if (!drawings) open();
  }

  function open() {
    drawings = 0;
    close(false);
    tellHolding();
    if (held.length && !writing) writeHeld();
  }

  const close = (is) => document.querySelectorAll("fieldset.redrawn").forEach((each) => (each.disabled = is));

  // All is stored, and the page goes on to another one: what is typed meanwhile goes there.
  function leave(address) {
    kept.over();
    goingTo = (window.path_prefix ?? "") + address;
    save();
    location.assign(goingTo);
  }

  function told(number) {
    telling.delete(number);
    kept.settled(number);
    save();
  }

  async function writeHeld() {
    writing = true;
    tellHolding();
    while (held.length && !waiting && !refused && !isLost && !goingTo && !drawings) {
      refused = !write(held[0]);
      if (!refused) held.shift();
      await pause(0); // the field tells its text before the next key comes
    }
    if (toPutRight && !waiting) goBack();
    if (refused && !waiting) await letRunOut();
    writing = false;
    save();
    tellHolding();
  }

  const tellHolding = () =>
    document.documentElement.classList.toggle("holding", waiting || writing || Boolean(goingTo || drawings));

  // Keys meant for after a rejected input must not go to the field that needs a correction.
  async function letRunOut() {
    let before = -1;
    while (before < held.length) {
      before = held.length;
      await pause(PAUSE_MS);
    }
    if (held.length) say("unused", `${SAID.meanwhile} ${held.splice(0).map(inWords).join("")}`);
    refused = false;
    toPutRight = null;
  }

  const pause = (ms) => new Promise((done) => setTimeout(done, ms));
  const inWords = (key) => ({ Enter: " ⏎ ", Tab: " ⇥ ", Back: " ⇤ ", Backspace: "⌫" })[key] ?? key;

  // Write one key where the focus is; whether there was a place for it.
  function write(key) {
    const here = document.activeElement;
    if (key === "Tab" || key === "Back") return step(here, key === "Tab" ? 1 : -1);
    if (here.matches("button, a") && (key === "Enter" || key === " ")) {
      here.click();
      return true;
    }
    if (!here.matches("input, textarea")) return false;
    if (key === "Enter") {
      here.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true, cancelable: true }));
      return true;
    }
    own = true; // written as a hand would: undo knows it, and every listener hears of it
    const done = key === "Backspace" ? document.execCommand("delete") : document.execCommand("insertText", false, key);
    own = false;
    return done || key === "Backspace";
  }

  function step(here, by) {
    const places = [...document.querySelectorAll("a[href], button, input, textarea, summary")];
    const isReached = (each) => each.tabIndex >= 0 && !each.matches(":disabled") && each.checkVisibility();
    const reached = places.filter((each) => each === here || isReached(each));
    const next = reached[reached.indexOf(here) + by];
    next?.focus();
    if (next?.matches("input")) next.select(); // as the browser's own way with this key
    return true;
  }

  // Enter

  const fieldsOf = (place) => [...place.querySelectorAll("input:not([readonly]):not([type=file])")];
  const behind = (field, place) => fieldsOf(place).slice(fieldsOf(place).indexOf(field) + 1);
  const isField = (event) => event.target.matches("input:not([role=combobox])");

  // In a form: on to the next field that is empty and must not be; from the last one the form is sent.
  function enter(event, emit) {
    if (!isField(event)) return;
    event.preventDefault();
    const isMissing = (field) => !field.value && !("optional" in field.dataset);
    const next = behind(event.target, event.currentTarget).find(isMissing);
    if (next) next.focus();
    else ask(emit, "enter");
  }

  // In a form that only the button sends: on to the next field.
  function onward(event) {
    if (!isField(event)) return;
    event.preventDefault();
    const next = behind(event.target, event.currentTarget).find((field) => field.checkVisibility());
    next?.focus();
    next?.select(); // typing replaces the present text
  }

  // In a reading: send it, and let the user type the next one meanwhile. Where there was another one before, the
  // lab asks why.
  function reading(event, emit) {
    event.preventDefault(); // else it would press the button that the focus goes to
    const field = event.target;
    const row = field.closest(".reading");
    const typed = field.value.trim();
    const before = beforeOf(row);
    if (before !== undefined && typed !== before) return ask(emit);
    tell(row, typed, emit);
    const next = behind(field, row.parentElement).find((each) => !each.value);
    const button = field.closest(".lab").querySelector(".then");
    (next ?? (typed ? button : null))?.focus();
  }

  // The last reading was refused: when what is typed already is written, and the next series not asked for, to its field.
  function refusedLast(id) {
    toPutRight = id;
    if (!writing) writeHeld();
  }

  // To the field of the last reading, all of it marked, unless somebody has gone elsewhere meanwhile. A hand that types on
  // has not seen it yet.
  function goBack() {
    const field = getHtmlElement(toPutRight)?.querySelector("input") ?? getHtmlElement(toPutRight);
    toPutRight = null;
    if (!field || !document.activeElement?.matches("button.then")) return;
    field.focus();
    field.select();
    refused = true;
  }

  // A field that needs a correction: show it, with the focus and its text selected.
  function goTo(id) {
    const place = getHtmlElement(id);
    const field = place?.matches("input") ? place : (place?.querySelector("input, [tabindex]") ?? place);
    for (let each = field; each; each = each.parentElement) if (each.matches("details")) each.open = true;
    field?.focus();
    field?.select?.();
    field?.scrollIntoView({ block: "center" });
  }

  // A reading is left: it counts as told, unless the connection closed its field, or only the window was left.
  function leaving(event, emit) {
    if (!isLost && event.target !== document.activeElement) tell(event.target.closest(".reading"), event.target.value.trim(), emit);
  }

  const beforeOf = (row) =>
    row.dataset.stored ?? (row.classList.contains("refused") ? undefined : row.dataset.sent);

  function tell(row, typed, emit) {
    if (!typed || beforeOf(row) !== undefined) return emit();
    row.dataset.sent = typed;
    const once = kept.reading(row, typed);
    telling.set(once, () => emit({ once, text: typed }));
    telling.get(once)();
  }

  // A photo as JPEG in base64: at most 1600 px, and as coarse as the store needs it; drawing it again drops data that a camera adds, such as a position.
  async function photo(event, emit) {
    const field = event.target;
    try {
      const picture = await createImageBitmap(field.files[0]);
      const scale = Math.min(1, 1600 / Math.max(picture.width, picture.height));
      const canvas = document.createElement("canvas");
      [canvas.width, canvas.height] = [picture.width, picture.height].map((side) => Math.max(1, Math.round(scale * side)));
      canvas.getContext("2d").drawImage(picture, 0, 0, canvas.width, canvas.height);
      const drawn = [0.85, 0.7, 0.5, 0.3].map((quality) => canvas.toDataURL("image/jpeg", quality).split(",")[1]);
      emit({ photo: drawn.find((text) => text.length < 900000) ?? drawn.at(-1) });
    } catch {
      emit({ refused: "photo" });
    }
    field.value = ""; // the same file can be chosen again
  }

  // The position, after the user pressed the button; the browser asks for consent, too.
  function position(event, emit) {
    if (!isSecureContext || !navigator.geolocation) return emit({ refused: "insecure" });
    const found = ({ coords: { latitude, longitude, accuracy } }) => emit({ latitude, longitude, accuracy });
    const failed = (error) => emit({ refused: error.code === error.PERMISSION_DENIED ? "denied" : "unavailable" });
    navigator.geolocation.getCurrentPosition(found, failed, { enableHighAccuracy: true, timeout: 20000 });
  }

  /** The page's language, whenever the framework sets its own. */
  function speak() {
    if (document.documentElement.lang !== language) document.documentElement.lang = language;
  }

  // The other language shows what is shown now, whatever the page was opened with.
  function comesBack(event) {
    const link = event.target.closest?.("a.language");
    if (link) link.search = `back=${encodeURIComponent(location.pathname + location.search)}`;
  }

  window.addEventListener("click", comesBack, true);
  window.addEventListener("keydown", keyPressed, true);
  window.addEventListener("beforeinput", textComes, true);
  window.addEventListener("input", () => setTimeout(save), true);
  window.addEventListener("pagehide", save);
  window.addEventListener("pageshow", () => goingTo && location.reload()); // come back to by the browser's button
  speak();
  new MutationObserver(speak).observe(document.documentElement, { attributeFilter: ["lang"] });
  document.documentElement.style.setProperty("--not-stored", JSON.stringify(SAID.refused));
  document.documentElement.classList.add("not-connected");
  document.documentElement.classList.toggle("is-insecure", !isSecureContext);
  tellHolding();
  window.lab = {
    ask, answered, connected, drawAnew, drawn, enter, goTo, grown, leave, leaving, onward, photo, position, reading, refusedLast, resent, told,
  };
})();
