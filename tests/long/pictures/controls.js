// SPDX-License-Identifier: BSL-1.0
// Uses the controls of a page as a person would, and says what is wrong: see check_controls.sh.
addEventListener('load', () => {
  const wrong = [];
  let sorted = 0;
  let filtered = 0;
  const texts = (table, column) => [...table.tBodies[0].rows].map(row => row.cells[column].textContent);
  const isMissing = text => text === '' || text === '-';
  for (const table of document.querySelectorAll('table')) {
    const rows = table.tBodies[0].rows.length;
    const heads = [...table.tHead.rows[0].cells];
    const button = head => head.querySelector('button');
    if (rows < 8 || !table.matches('h2 ~ *')) {
      if (heads.some(button)) wrong.push('a small table has buttons');
      continue;
    }
    heads.forEach((head, column) => {
      if (!button(head)) {
        wrong.push(`column ${head.textContent} has no button`);
        return;
      }
      const before = texts(table, column).sort().join();
      for (const way of ['ascending', 'descending']) {
        button(head).focus();
        if (document.activeElement !== button(head)) wrong.push('a head cannot have the focus');
        button(head).click();
        const after = texts(table, column);
        if (after.slice().sort().join() !== before) wrong.push(`sorting changes ${head.textContent}`);
        if (head.getAttribute('aria-sort') !== way) wrong.push(`${head.textContent} is not ${way}`);
        // Of plain numbers, and what is none: others are another matter than that of this check.
        const isNumber = text => /^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i.test(text);
        const given = after.filter(text => !isMissing(text));
        if (!given.length || !given.every(isNumber)) continue;
        const sign = way === 'ascending' ? 1 : -1;
        const inOrder = given.every((text, i) => i === 0 || sign * (Number(text) - Number(given[i - 1])) >= 0);
        if (!inOrder) wrong.push(`${head.textContent} is not in order: ${given}`);
        if (after.findIndex(isMissing) >= 0 && after.slice(after.findIndex(isMissing)).some(text => !isMissing(text)))
          wrong.push(`${head.textContent}: what is missing is not last`);
        ++sorted;
      }
    });
    const input = table.previousElementSibling?.querySelector('input');
    if (!input) {
      wrong.push('a field is missing');
      continue;
    }
    const visible = () => [...table.tBodies[0].rows].filter(row => row.offsetParent !== null);
    const cells = [...table.tBodies[0].rows[0].cells].map(cell => cell.textContent);
    const word = cells.sort((a, b) => b.length - a.length)[0];
    const write = text => {
      input.value = text;
      input.dispatchEvent(new Event('input'));
    };
    write(word.toUpperCase());
    if (!visible().length || visible().length === rows) wrong.push(`${visible().length} rows have ${word}`);
    if (visible().some(row => !row.textContent.includes(word))) wrong.push('a row without the word is seen');
    if (!input.closest('p').textContent.includes(`${visible().length} of ${rows} rows`)) wrong.push('no count');
    write('no row has this');
    if (visible().length) wrong.push('rows without the word are seen');
    write('');
    if (visible().length !== rows) wrong.push('an empty field hides rows');
    ++filtered;
  }
  const found = document.createElement('pre');
  found.id = 'found';
  found.textContent = wrong.length ? `wrong: ${[...new Set(wrong)].join('; ')}`
    : `${sorted} sorted, ${filtered} filtered`;
  document.body.append(found);
});
