// What the reader has chosen stands in the address bar behind #, so that a link or a reload gives
// the same view: #tolerance=1e-06&off=pgs&off=nncg. A name may stand several times: a list.

const choice = (() => {
  let text = "", values = new URLSearchParams();
  const listeners = [];
  const read = () => {
    text = location.hash.slice(1);
    // an address without "=" leads to a section of the page: nothing is chosen by it
    values = new URLSearchParams(text.includes("=") ? text : "");
  };
  read();
  addEventListener("hashchange", () => {
    if (location.hash.slice(1) === text) return;
    read();
    for (const tell of listeners) tell();
  });
  return {
    get: (name, otherwise = "") => values.get(name) ?? otherwise,
    list: (name) => values.getAll(name),
    has: (name, value) => values.getAll(name).includes(value),
    /// A string, a list, or null: nothing chosen.
    set(name, value) {
      values.delete(name);
      for (const one of [value ?? []].flat()) values.append(name, one);
      text = values.toString();
      // not history.replaceState: some browsers refuse it to files
      location.replace("#" + text);
      for (const tell of listeners) tell();
    },
    toggle(name, value) {
      const list = values.getAll(name);
      this.set(name, list.includes(value) ? list.filter((one) => one !== value) : [...list, value]);
    },
    changed: (tell) => listeners.push(tell),
  };
})();
