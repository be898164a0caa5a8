// What the reader has chosen stands in the address bar behind #, so that a link or a reload gives
// the same view: #tolerance=1e-06&off=pgs&off=nncg. A name may stand several times: a list.

const choice = (() => {
  let text = "", values = new URLSearchParams();
  const listeners = [];
  const read = () => {
    text = location.hash.slice(1);
    // an address without "=" leads to a section of the page: nothing is chosen by it
    values = new URLSearchParams(text.includes("=") ? text : "");
    values.delete("");
  };
  const write = () => {
    // an empty address would lead to the top of the page
    const next = values.toString() || (text && "=");
    if (next === text) return;
    text = next;
    // not history.replaceState: some browsers refuse it to files
    location.replace("#" + text);
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
      this.keep({ [name]: value });
      for (const tell of listeners) tell();
    },
    /// Several at once, which the page shows already: its listeners are not told.
    keep(changes) {
      read();  // a replay in the page keeps its own there
      for (const [name, value] of Object.entries(changes)) {
        values.delete(name);
        for (const one of [value ?? []].flat()) values.append(name, one);
      }
      write();
    },
    toggle(name, value) {
      const list = values.getAll(name);
      this.set(name, list.includes(value) ? list.filter((one) => one !== value) : [...list, value]);
    },
    changed: (tell) => listeners.push(tell),
  };
})();
