"use strict";
// Tables: heads become buttons that sort, and long tables are shown in pages.
(() => {
  const ROWS = 500;

  const value = (row, column) => {
    const cell = row.cells[column];
    const number = cell.classList.contains("n");
    if (!number) return cell.textContent;
    return cell.dataset.v === undefined ? NaN : Number(cell.dataset.v.replace("inf", "Infinity"));
  };

  const compare = (a, b, sign) => {
    if (typeof a === "string") return sign * a.localeCompare(b, "en", { numeric: true });
    if (Number.isNaN(a) || Number.isNaN(b)) return Number.isNaN(a) - Number.isNaN(b); // what is missing is last
    return a === b ? 0 : sign * (a < b ? -1 : 1);
  };

  const paged = (table) => {
    const body = table.tBodies[0];
    if (body.rows.length <= ROWS) return () => {};
    const bar = document.createElement("div"), told = document.createElement("span");
    const button = (name, step) => {
      const made = document.createElement("button");
      made.type = "button";
      made.textContent = name;
      made.onclick = () => show(page + step);
      return made;
    };
    const back = button("Previous", -1), on = button("Next", 1);
    let page = 0;
    const show = (wanted) => {
      page = wanted;
      const first = page * ROWS, last = Math.min(first + ROWS, body.rows.length);
      [...body.rows].forEach((row, i) => { row.hidden = i < first || i >= last; });
      told.textContent = `${first + 1} to ${last} of ${body.rows.length} rows`;
      back.disabled = page === 0;
      on.disabled = last === body.rows.length;
    };
    bar.className = "pager";
    bar.append(back, told, on);
    table.parentElement.after(bar);
    show(0);
    return () => show(0);
  };

  for (const table of document.querySelectorAll("table.sortable")) {
    const heads = [...table.tHead.rows[0].cells], restart = paged(table);
    heads.forEach((head, column) => {
      const button = document.createElement("button");
      button.type = "button";
      button.append(...head.childNodes);
      head.append(button);
      button.onclick = () => {
        const sign = head.getAttribute("aria-sort") === "ascending" ? -1 : 1;
        heads.forEach((other) => other.removeAttribute("aria-sort"));
        head.setAttribute("aria-sort", sign > 0 ? "ascending" : "descending");
        const rows = [...table.tBodies[0].rows].map((row) => [value(row, column), row]);
        rows.sort((a, b) => compare(a[0], b[0], sign));
        table.tBodies[0].append(...rows.map(([, row]) => row));
        restart();
      };
    });
  }
})();
