// What is typed and not stored yet, kept in the browser: it outlives a reload of the page and a restart of the lab.
// A reading is kept under its key until the lab answers; the text of fields is kept for each
// page of this tab, with the field that it is typed in and the keys that were held.
(() => {
  "use strict";

  const READING = "skisnow.reading.";
  const PAGE = "skisnow.page.";
  const keeps = "keeps" in document.currentScript.dataset;
  const typed = new WeakSet(); // fields that somebody wrote in
  let here = ""; // the page that was kept last
  let isOver = false;
  let restored = false; // nothing is written over what was kept before it was put back
  let first = null; // the form as the page was loaded
  let onward = null; // texts for the next page

  // A browser may forbid its storage: then nothing is kept, and all else goes on.
  const quietly = (act) => { try { return act(); } catch { return null; } };
  const read = (store, key) => quietly(() => JSON.parse(window[store].getItem(key)));
  const keep = (store, key, value) => quietly(() => window[store].setItem(key, JSON.stringify(value)));
  const forget = (store, key) => quietly(() => window[store].removeItem(key));

  const place = () => location.pathname + location.search;
  const before = read("sessionStorage", PAGE + place()) ?? {}; // texts that were kept when the page was loaded

  // Numbers

  function tab() {
    let name = read("sessionStorage", "skisnow.tab");
    if (!name) {
      name = [...crypto.getRandomValues(new Uint8Array(8))].map((byte) => byte.toString(16).padStart(2, "0")).join("");
      keep("sessionStorage", "skisnow.tab", name);
    }
    return name;
  }

  let numbered = 0;
  const opened = Date.now(); // a tab that was copied counts on from the same number, but not at the same time

  const newOnce = () => `${tab()}-${opened}-${(numbered += 1)}`;

  // Key of this page's request: the same until it is stored, also after a reload.
  function once() {
    const page = read("sessionStorage", PAGE + place()) ?? {};
    if (!page.once) keep("sessionStorage", PAGE + place(), { ...page, once: (page.once = newOnce()) });
    return page.once;
  }

  // Readings

  const campaign = () => location.pathname.match(/^\/enter\/([0-9a-f]+)/)?.[1] ?? "";

  function reading(row, depth) {
    const number = newOnce();
    const head = JSON.parse(row.parentElement.dataset.head);
    const cells = { ...head, load_N: row.dataset.load, depth_mm: depth };
    if (row.dataset.branch) cells.branch = row.dataset.branch;
    const who = document.querySelector(".who")?.dataset.who ?? "";
    keep("localStorage", READING + number, { once: number, at: Date.now(), campaign: campaign(), who, cells });
    return number;
  }

  const settled = (number) => forget("localStorage", READING + number);

  // Unanswered readings of this campaign in the order of typing.
  function readings() {
    const keys = quietly(() => Object.keys(window.localStorage)) ?? [];
    const found = keys.filter((key) => key.startsWith(READING)).map((key) => read("localStorage", key));
    return found.filter((each) => each && each.campaign === campaign()).sort((a, b) => a.at - b.at);
  }

  // Fields

  const nameOf = (field) => field?.getAttribute("aria-label") || field?.innerText?.trim() || "";
  const thens = () => document.querySelectorAll("button:is(.then, .adds)");
  const fields = () => [...document.querySelectorAll("fieldset.lab :is(input, textarea):not([type=file])")];
  const focusable = (element) => element?.closest("input, textarea, button");
  const isStored = (field, text) => field.closest(".reading")?.dataset.stored === text.trim().replace(",", ".");

  function save(state, focused) {
    if (isOver) return;
    if (!restored) return saveHeld(state);
    if (here && here !== place()) forget("sessionStorage", PAGE + here); // another form of the same page
    here = place();
    const written = fields().filter((each) => keeps && typed.has(each) && !each.readOnly && !isStored(each, each.value));
    const texts = Object.fromEntries(written.map((each) => [nameOf(each), each.value]));
    const grew = JSON.stringify(form()) !== first;
    const kept = { once: read("sessionStorage", PAGE + here)?.once, texts, at: nameOf(focusable(focused)), ...state };
    if (grew) kept.form = form();
    if (kept.once || kept.held?.length || written.length || grew) keep("sessionStorage", PAGE + here, kept);
    else forget("sessionStorage", PAGE + here);
  }

  // The page is left before it was connected: add the texts held since to the kept ones.
  function saveHeld({ held, ahead }) {
    if (!held.length) return;
    keep("sessionStorage", PAGE + place(), { ahead, ...before, held: [...(before.held ?? []), ...held] });
  }

  // Rows of a growing form with their choices; the lab adds them again before texts are restored.
  function form() {
    const rows = [...document.querySelectorAll("[data-rows]")];
    const choices = [...document.querySelectorAll("[data-rows] [role=combobox]")];
    return {
      rows: Object.fromEntries(rows.map((each) => [each.dataset.rows, each.children.length])),
      choices: Object.fromEntries(choices.map((each) => [nameOf(each), each.value])),
    };
  }

  // State of the form before the page was loaded again, where it differs from the shown one.
  function missing() {
    const shown = JSON.stringify(form());
    first ??= shown;
    return before.form && JSON.stringify(before.form) !== shown ? before.form : null;
  }

  // The page goes on to an address of the lab: keys that were held go there.
  function handOn(address, held) {
    const there = (onward ??= read("sessionStorage", PAGE + address) ?? {});
    if (held.length) keep("sessionStorage", PAGE + address, { ...there, ahead: true, held: [...(there.held ?? []), ...held] });
  }

  // The request of this page is stored: remove the kept texts.
  function done() {
    forget("sessionStorage", PAGE + place());
  }

  function write(field, text) {
    const kind = field.matches("textarea") ? HTMLTextAreaElement : HTMLInputElement;
    Object.getOwnPropertyDescriptor(kind.prototype, "value").set.call(field, text);
    field.dispatchEvent(new Event("input", { bubbles: true }));
  }

  // The page is left, and all that was typed in it is stored.
  function over() {
    done();
    isOver = true;
  }

  // Restore typed texts; return those without a field in words. `ready`: the focus is where it was.
  function restore() {
    const kept = before;
    const byName = Object.fromEntries([...fields(), ...thens()].map((each) => [nameOf(each), each]));
    const without = [];
    for (const [name, text] of Object.entries(kept.texts ?? {})) {
      const field = byName[name];
      if (!field || field.readOnly) without.push(`${name}: ${text}`);
      else if (!isStored(field, text) && field.value !== text) write(field, text);
    }
    const focus = byName[kept.at];
    const ready = Boolean(kept.at && focus?.checkVisibility());
    if (ready && (kept.held?.length || kept.at in (kept.texts ?? {}))) {
      focus.focus();
      focus.setSelectionRange?.(focus.value.length, focus.value.length);
    }
    restored = true;
    return { held: kept.held ?? [], ahead: Boolean(kept.ahead), ready, without };
  }

  // The connection was lost: tell the lab once more what the fields hold, in case that it was lost, too.
  async function tellAgain() {
    const written = fields().filter((field) => typed.has(field) && !field.readOnly);
    const texts = written.map((each) => each.value);
    written.forEach((each, i) => write(each, `${texts[i]} `)); // the framework sends only differences
    await new Promise((told) => setTimeout(told));
    written.forEach((each, i) => write(each, texts[i]));
    await new Promise((told) => setTimeout(told));
  }

  window.addEventListener("input", (event) => typed.add(event.target), true);
  window.kept = { keeps, once, reading, readings, settled, save, done, over, restore, tellAgain, missing, handOn };
})();
