// The triangles of all grains as one buffer, and each frame the list of those that can be seen.

// A corner has 12 bytes: position (int16 x 3), grain (uint16), normal (int8 x 3), and which edges
// of its triangle lie inside a face.
class Mesh {
  constructor(data) {
    this.data = data;
    const fans = data.shapes.map(({ vertices, faces }) => Mesh.fansOf(vertices, faces));
    const shapeOf = data.head.shape_of;
    const triangles = shapeOf.reduce((sum, shape) => sum + fans[shape].triangles.length, 0);
    this.corners = 3 * triangles;
    this.bytes = new ArrayBuffer(12 * this.corners);
    this.first = new Uint32Array(data.grains + 1);
    this.shapes = fans;
    const shorts = new Int16Array(this.bytes), words = new Uint16Array(this.bytes);
    const small = new Int8Array(this.bytes), flags = new Uint8Array(this.bytes);
    let at = 0;
    for (let g = 0; g < data.grains; ++g) {
      const { vertices } = data.shapes[shapeOf[g]], { triangles: fan, planes } = fans[shapeOf[g]];
      for (const { loop, hidden, face } of fan)
        for (const v of loop) {
          for (let k = 0; k < 3; ++k) {
            shorts[6 * at + k] = vertices[3 * v + k];
            small[12 * at + 8 + k] = Math.round(127 * planes[4 * face + k]);
          }
          words[6 * at + 3] = g;
          flags[12 * at + 11] = hidden;
          ++at;
        }
      this.first[g + 1] = at;
    }
    this.index = new Uint32Array(this.corners);
    this.order = Uint32Array.from({ length: data.grains }, (_, g) => g);
    this.distance = new Float32Array(data.grains);
  }

  // The faces of a shape as fans of triangles, and their planes: normal and offset [m].
  static fansOf(vertices, faces) {
    const triangles = [], planes = new Float32Array(4 * faces.length);
    const corner = (v) => [vertices[3 * v], vertices[3 * v + 1], vertices[3 * v + 2]];
    faces.forEach((loop, face) => {
      const a = corner(loop[0]);
      let normal = [0, 0, 0];
      for (let k = 2; k < loop.length; ++k) {
        normal = add(normal, cross(sub(corner(loop[k - 1]), a), sub(corner(loop[k]), a)));
        const hidden = (k < loop.length - 1 ? 2 : 0) | (k > 2 ? 4 : 0);
        triangles.push({ loop: [loop[0], loop[k - 1], loop[k]], hidden, face });
      }
      normal = unit(normal);
      planes.set([...normal, dot(normal, a)], 4 * face);
    });
    return { triangles, planes };
  }

  // Nearest grains first, faces that look away left out. `seen`: which grains at all; null: all.
  // Returns how many entries of `index` hold.
  visible(eye, seen) {
    const { data, order, distance, index, first } = this, state = data.state;
    for (let g = 0; g < data.grains; ++g)
      distance[g] = (state[8 * g] - eye[0]) ** 2 + (state[8 * g + 1] - eye[1]) ** 2 +
        (state[8 * g + 2] - eye[2]) ** 2;
    order.sort((a, b) => distance[a] - distance[b]);
    let count = 0;
    for (const g of order) {
      if (seen && !seen[g]) continue;
      const { triangles, planes } = this.shapes[data.head.shape_of[g]], at = 8 * g;
      const local = turned(state.subarray(at + 4, at + 8),
        sub(eye, state.subarray(at, at + 3)), -1);
      const scale = 32767 / data.head.scale;
      let corner = first[g], face = -1, faces = false;
      for (const triangle of triangles) {
        if (triangle.face !== face) {
          face = triangle.face;
          faces = (planes[4 * face] * local[0] + planes[4 * face + 1] * local[1] +
            planes[4 * face + 2] * local[2]) * scale > planes[4 * face + 3];
        }
        if (faces) {
          index[count] = corner;
          index[count + 1] = corner + 1;
          index[count + 2] = corner + 2;
          count += 3;
        }
        corner += 3;
      }
    }
    return count;
  }
}
