// The numbers of the mark that is nearest to the pointer, or that the keys have reached.
"use strict";
for (const figure of document.querySelectorAll("figure.chart-figure")) {
  const value = figure.querySelector(".chart-value");
  const hint = value.textContent;
  for (const svg of figure.querySelectorAll("svg")) {
    const marks = [...svg.querySelectorAll(".mark")].filter((mark) => mark.querySelector("title"));
    if (!marks.length) continue;
    let shown = -1;
    const show = (number) => {
      if (number === shown) return;
      if (shown >= 0) marks[shown].classList.remove("near");
      shown = number;
      if (shown >= 0) marks[shown].classList.add("near");
      value.textContent = shown >= 0 ? marks[shown].querySelector("title").textContent : hint;
    };
    const nearest = (event) => {
      let best = -1;
      let least = 40;  // pixels; what is further away is not meant
      marks.forEach((mark, number) => {
        const box = mark.getBoundingClientRect();
        const distance = Math.hypot(event.clientX - box.x - box.width / 2, event.clientY - box.y - box.height / 2);
        if (distance < least) [least, best] = [distance, number];
      });
      show(best);
    };
    svg.addEventListener("pointermove", nearest);
    svg.addEventListener("pointerdown", nearest);
    svg.addEventListener("pointerleave", () => show(-1));
    svg.tabIndex = 0;
    svg.addEventListener("blur", () => show(-1));
    svg.addEventListener("keydown", (event) => {
      const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
      if (!step) return;
      event.preventDefault();
      show((shown + step + marks.length + (shown < 0 && step < 0 ? 1 : 0)) % marks.length);
    });
  }
}
