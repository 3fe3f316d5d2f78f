// Where scripts run, tables below the first heading are sorted and filtered; those of a few rows are read at a
// glance. What is no number goes last in a column of numbers, whichever way the column is sorted. Nothing is
// fetched, and without the script the page is whole.
'use strict';
const numberIn = text => {
  const found = /^(?:below |above |< )?([-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?)/i.exec(text);
  return found ? Number(found[1]) : text === 'inf' ? Infinity : NaN;
};
const made = (tag, properties, ...children) => {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
};
for (const table of document.querySelectorAll('table')) {
  const rows = [...table.tBodies[0].rows];
  if (rows.length < 8 || !table.matches('h2 ~ *')) continue;
  [...table.tHead.rows[0].cells].forEach((head, column) => {
    const button = made('button', { type: 'button', title: 'Sort by this column' }, ...head.childNodes);
    head.append(button);
    button.addEventListener('click', () => {
      const way = head.getAttribute('aria-sort') === 'ascending' ? -1 : 1;
      for (const other of table.tHead.rows[0].cells) other.removeAttribute('aria-sort');
      head.setAttribute('aria-sort', way > 0 ? 'ascending' : 'descending');
      const texts = new Map(rows.map(row => [row, row.cells[column].textContent.trim()]));
      const given = [...texts.values()].filter(text => text && text !== '-');
      const numeric = 2 * given.filter(text => !isNaN(numberIn(text))).length > given.length;
      const key = row => numeric ? numberIn(texts.get(row)) : texts.get(row);
      const last = row => numeric ? isNaN(key(row)) : !key(row) || key(row) === '-';
      const compared = (a, b) => numeric ? Math.sign(key(a) - key(b)) || 0
        : key(a).localeCompare(key(b), 'en', { numeric: true });
      rows.sort((a, b) => last(a) - last(b) || (last(a) ? 0 : way * compared(a, b)));
      table.tBodies[0].append(...rows);
    });
  });
  const input = made('input', { type: 'search', autocomplete: 'off' });
  const shown = made('output');
  input.addEventListener('input', () => {
    const words = input.value.toLowerCase().split(/\s+/).filter(Boolean);
    for (const row of rows) row.hidden = !words.every(word => row.textContent.toLowerCase().includes(word));
    const seen = rows.filter(row => !row.hidden).length;
    shown.textContent = words.length ? `${seen} of ${rows.length} rows` : '';
  });
  const label = made('label', {}, 'Rows with ', input);
  table.before(made('p', { className: 'filter' }, label, ' ', shown));
}
