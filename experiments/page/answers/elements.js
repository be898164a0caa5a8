// Makes elements of the page in one line each; downloads, copies and unpacks data.

/// Returns an element with attributes and children (elements or strings; null is left out).
/// Attributes `on...` are listeners.
function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
    else made.setAttribute(name, value === true ? "" : value);
  }
  made.append(...children.filter((child) => child !== null && child !== undefined));
  return made;
}

/// Returns a button; `attributes` are those of element().
function button(words, pressed, attributes = {}) {
  return element("button", { type: "button", onclick: pressed, ...attributes }, words);
}

/// Lets the reader keep `text` as a file.
function download(name, text) {
  const address = URL.createObjectURL(new Blob([text], { type: "text/csv" }));
  const link = element("a", { href: address, download: name });
  document.body.append(link);
  link.click();
  link.remove();
  URL.revokeObjectURL(address);
}

/// Puts `text` on the clipboard, and says so on the button that was pressed. In some browsers pages
/// opened from disk have no clipboard interface: then the text is copied through a field.
async function copy(text, pressed) {
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    const field = element("textarea", { class: "unseen" }, text);
    document.body.append(field);
    field.select();
    document.execCommand("copy");
    field.remove();
    pressed.focus();
  }
  const words = pressed.textContent;
  pressed.textContent = "copied";
  setTimeout(() => { pressed.textContent = words; }, 1500);
}

/// Returns the bytes that an element holds deflated and in base64, read chunk by chunk (a Response
/// takes three times as long). Empties the element.
async function unpacked(holder) {
  if (!window.DecompressionStream) throw new Error("this browser is too old to unpack the data");
  const letters = atob(holder.textContent), packed = new Uint8Array(letters.length), chunks = [];
  for (let k = 0; k < packed.length; ++k) packed[k] = letters.charCodeAt(k);
  holder.textContent = "";
  const inflated = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  const reader = inflated.getReader();
  for (let got = await reader.read(); !got.done; got = await reader.read()) chunks.push(got.value);
  return new Blob(chunks);
}
