// SPDX-License-Identifier: BSL-1.0
// What a report holds, when it is loaded: see check_page.sh.
addEventListener('load', () => {
  const boxes = [...document.querySelectorAll('figure img')].map(svg => {
    const box = svg.getBoundingClientRect();
    return [box.x, box.y, box.width, box.height].map(Math.round).join(',');
  });
  const loads = [...document.querySelectorAll('link, img, image, iframe, object, embed, audio, video, script')]
    .filter(element => element.tagName !== 'SCRIPT' || element.src)
    .filter(element => !String(element.src).startsWith('data:'))
    .map(element => element.tagName);
  const styles = [...document.querySelectorAll('style, [style]')]
    .map(element => element.textContent + (element.getAttribute('style') || ''))
    .filter(text => /@import|url\((?!['"]?#)/.test(text))
    .map(() => 'STYLE');
  const requests = performance.getEntriesByType('resource').map(entry => entry.name)
    .filter(name => !name.startsWith('data:'));
  const asked = [...loads, ...styles, ...requests].join(',').replace(/\s/g, '') || 'nothing';
  const found = document.createElement('pre');
  found.id = 'found';
  const figures = document.querySelectorAll('figure').length;
  const height = Math.ceil(document.documentElement.scrollHeight);
  found.textContent = [figures, boxes.length, height, asked, ...boxes].join(' ');
  document.body.append(found);
});
