// SPDX-License-Identifier: BSL-1.0
// How many thousandths of each box of a screenshot are not white: see check_page.sh.
const image = new Image();
image.onload = () => {
  const canvas = document.createElement('canvas');
  [canvas.width, canvas.height] = [image.width, image.height];
  const context = canvas.getContext('2d');
  context.drawImage(image, 0, 0);
  const inks = boxes.split(' ').map(box => {
    const [x, y, width, height] = box.split(',').map(Number);
    if (width < 1 || height < 1) return 0;
    const pixels = context.getImageData(x, y, width, height).data;
    let ink = 0;
    for (let i = 0; i < pixels.length; i += 4) {
      if (Math.min(pixels[i], pixels[i + 1], pixels[i + 2]) < 200) ++ink;
    }
    return Math.round(1000 * ink / (width * height));
  });
  const found = document.createElement('pre');
  found.id = 'found';
  found.textContent = inks.join(' ');
  document.body.append(found);
};
image.src = screenshot;
