// Blocks of code: a button that copies them, and a place in the tab order, so that long lines can be scrolled by key; wide equations and figures too.
"use strict";

const COMMAND = /^(\$ )?(skisnow|make|python|pip|\.venv\/bin\/|\.ci\/|git|kill)\b|^ +/;
/** What is aligned in columns, or is a program, scrolls: it would be hard to read in broken lines. */
const COLUMNS = /\S {3,}\S|[|│┌└─]/;

/** What a reader wants to paste: without prompts, and of a session only what was typed. */
function typed(text) {
  const lines = text.replace(/\n$/, "").split("\n");
  if (!lines.some((line) => line.startsWith(">>> "))) return lines.join("\n");
  return lines.filter((line) => /^(>>>|\.\.\.)( |$)/.test(line)).map((line) => line.slice(4)).join("\n");
}

/** Copy even where the page is a file and the browser gives it no clipboard. */
async function copy(text) {
  if (navigator.clipboard) return navigator.clipboard.writeText(text);
  const area = Object.assign(document.createElement("textarea"), { value: text });
  document.body.append(area);
  area.select();
  document.execCommand("copy");
  area.remove();
}

function furnished(block) {
  const pre = block.querySelector("pre");
  const text = pre.textContent;
  pre.tabIndex = 0;
  pre.setAttribute("role", "group");
  pre.setAttribute("aria-label", "code");
  const sentences = !block.closest(".highlight-python, .highlight-toml, .highlight-json, .doctest") && !text.includes(">>> ");
  if (text.split("\n").every((line) => !line || COMMAND.test(line)) || (sentences && !COLUMNS.test(text))) {
    block.classList.add("wraps");
  }
  const button = Object.assign(document.createElement("button"), { className: "copy", type: "button", textContent: "Copy" });
  button.setAttribute("aria-label", "Copy this code");
  button.addEventListener("click", async () => {
    await copy(typed(text));
    button.textContent = "Copied";
    setTimeout(() => { button.textContent = "Copy"; }, 1500);
  });
  block.append(button);
}

/** What is wider than the page has a place in the tab order, and only that. */
function reachable() {
  document.querySelectorAll("article .equation, article figure, article p:has(> img:only-child)").forEach((each) => {
    if (each.scrollWidth > each.clientWidth) each.tabIndex = 0;
    else each.removeAttribute("tabindex");
  });
}

document.addEventListener("DOMContentLoaded", () => {
  document.querySelectorAll("article div.highlight").forEach(furnished);
  reachable();
});
addEventListener("load", reachable);
addEventListener("resize", reachable);
