// The replay on the first page: plays from the beginning to the end again and again.

const FILES = "/replay/files";
const script = document.currentScript;

async function place() {
  for (;;) {
    const element = document.getElementById("first-replay");
    if (element) return element;
    await new Promise((done) => setTimeout(done, 50));
  }
}

async function start() {
  const [root, { startReplay }, answer] = await Promise.all([place(), import(`${FILES}/replay.js`), fetch("/replay/first")]);
  const player = startReplay(root, { run: await answer.arrayBuffer(), words: JSON.parse(script.dataset.words), isCalm: true });
  window.skisnowReplay = player;
  root.setAttribute("data-plays", "");
  const rest = window.matchMedia("(prefers-reduced-motion: reduce)").matches;
  setInterval(() => {
    if (!rest && !player.playing && player.time >= player.end && root.isConnected) player.play();
  }, 1000);
}

start().catch((error) => {
  place().then((root) => root.remove());
  console.info(`no replay: ${error.message}`);
});
