"use strict";
/* What is chosen, in the address of the page: a link leads to the same place. */

const chosenInAddress = new URLSearchParams(location.hash.slice(1));

/** The number chosen under a name; null where there is none. */
function remembered(name) {
  const found = Number(chosenInAddress.get(name) ?? NaN);
  return Number.isFinite(found) ? found : null;
}

function remember(name, value) {
  chosenInAddress.set(name, value);
  history.replaceState(null, "", `#${chosenInAddress}`);
}

document.getElementById("reset").addEventListener("click", () => {
  history.replaceState(null, "", location.pathname + location.search);
  location.reload();
});
