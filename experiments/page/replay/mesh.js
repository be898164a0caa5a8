// The triangles of all grains as one buffer. A corner has 12 bytes: position (int16 x 3), the
// grain's number modulo 2^16 (uint16), normal (int8 x 3), and 8 bits: 3 mark the edges of its
// triangle that lie inside a face, 5 hold the grain's number / 2^16.

class Mesh {
  constructor(data) {
    this.data = data;
    this.fans = data.shapes.map(({ vertices, faces }) => Mesh.fanOf(vertices, faces));
    this.corners = 3 * data.head.shape_of.reduce((sum, s) => sum + this.fans[s].length, 0);
  }

  // The buffer, made on first use.
  get bytes() { return this.made ??= this.make(); }
  make() {
    const { data: { shapes, head }, fans } = this, bytes = new ArrayBuffer(12 * this.corners);
    const shorts = new Int16Array(bytes), words = new Uint16Array(bytes);
    const small = new Int8Array(bytes);
    let at = 0;
    head.shape_of.forEach((shape, grain) => {
      const { vertices } = shapes[shape];
      for (const { loop, hidden, normal } of fans[shape])
        for (const v of loop) {
          for (let k = 0; k < 3; ++k) {
            shorts[6 * at + k] = vertices[3 * v + k];
            small[12 * at + 8 + k] = Math.round(127 * normal[k]);
          }
          words[6 * at + 3] = grain;
          small[12 * at + 11] = hidden | (grain >> 16) << 3;
          ++at;
        }
    });
    return bytes;
  }

  // The faces of a shape as fans of triangles.
  static fanOf(vertices, faces) {
    const corner = (v) => [vertices[3 * v], vertices[3 * v + 1], vertices[3 * v + 2]];
    return faces.flatMap((face) => {
      const a = corner(face[0]), triangles = [];
      let normal = [0, 0, 0];
      for (let k = 2; k < face.length; ++k) {
        normal = add(normal, cross(sub(corner(face[k - 1]), a), sub(corner(face[k]), a)));
        const hidden = (k < face.length - 1 ? 2 : 0) | (k > 2 ? 4 : 0);
        triangles.push({ loop: [face[0], face[k - 1], face[k]], hidden });
      }
      return triangles.map((triangle) => ({ ...triangle, normal: unit(normal) }));
    });
  }
}
