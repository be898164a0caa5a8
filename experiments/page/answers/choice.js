// The reader's choices are kept in the address bar behind #, so that a link or a reload gives the
// same view: #tolerance=1e-06&off=pgs&off=nncg. A name that occurs several times is a list.

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
    // not history.replaceState: some browsers refuse it to pages opened from disk
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
    /// Sets a choice to a string, a list, or null (nothing chosen), and tells the listeners.
    set(name, value) {
      this.keep({ [name]: value });
      for (const tell of listeners) tell();
    },
    /// Sets several choices that the page shows already: the listeners are not told.
    keep(changes) {
      read();  // a replay in the page keeps its choices in the address, too
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
