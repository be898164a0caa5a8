#include "solvers/parts/dense_kernels.hpp"

#include <algorithm>
#include <cstdint>

#include "platform/for_each_cpu.hpp"

namespace ballast {
namespace {

constexpr int tile_rows = 8;     // of a tile of C: one register of 512 bits, two of 256
constexpr int tile_columns = 6;  // so that 12 of the 16 registers of 256 bits hold sums
constexpr int tall_rows = 16;    // for 512 bits: 12 of 32; with fewer, loads take longer than sums
constexpr int chunk = 256;       // terms of the sum over k at once: packed A stays in cache
constexpr int strip = 24;        // rows that are solved before a long product

/// `height` rows of a column, in registers of `bytes` bytes.
template <int bytes, int height = tile_rows>
struct Rows {
  static constexpr int lanes = bytes / static_cast<int>(sizeof(double)), count = height / lanes;
  typedef double Register __attribute__((vector_size(bytes)));
  typedef double Loose __attribute__((vector_size(bytes), aligned(8), may_alias));
  Register part[count];

  BALLAST_IN_LOOP void clear() {
    for (int i = 0; i < count; ++i) part[i] = Register{};
  }
  BALLAST_IN_LOOP void load(const double* from) {
    for (int i = 0; i < count; ++i) part[i] = *reinterpret_cast<const Loose*>(from + i * lanes);
  }
  BALLAST_IN_LOOP void store(double* to) const {
    for (int i = 0; i < count; ++i) *reinterpret_cast<Loose*>(to + i * lanes) = part[i];
  }
  /// Loads the first `rows` rows and sets the others to zero.
  BALLAST_IN_LOOP void load(const double* from, int rows) {
    if (rows == height) return load(from);
    double all[height];
    for (int i = 0; i < height; ++i) all[i] = i < rows ? from[i] : 0.0;
    load(all);
  }
  BALLAST_IN_LOOP void store(double* to, int rows) const {
    if (rows == height) return store(to);
    double all[height];
    store(all);
    for (int i = 0; i < rows; ++i) to[i] = all[i];
  }
};

/// N columns of C -= packed A times B.
template <int N, int bytes, int height>
BALLAST_IN_LOOP void subtract_tile(int rows, int depth, const Rows<bytes, height>* packed,
                                   const double* b, std::int64_t stride_b, double* c,
                                   std::int64_t stride_c) {
  Rows<bytes, height> sum[N];
  for (int j = 0; j < N; ++j) sum[j].clear();
  for (int p = 0; p < depth; ++p)
    for (int j = 0; j < N; ++j)
      for (int i = 0; i < sum[j].count; ++i)
        sum[j].part[i] += packed[p].part[i] * b[j * stride_b + p];
  for (int j = 0; j < N; ++j, c += stride_c) {
    Rows<bytes, height> there;
    there.load(c, rows);
    for (int i = 0; i < sum[j].count; ++i) there.part[i] -= sum[j].part[i];
    there.store(c, rows);
  }
}

/// subtract_tile() for `columns` columns, at most N.
template <int N, int bytes, int height>
BALLAST_IN_LOOP void subtract_last(int columns, int rows, int depth,
                                   const Rows<bytes, height>* packed, const double* b,
                                   std::int64_t stride_b, double* c, std::int64_t stride_c) {
  if (columns == N) return subtract_tile<N>(rows, depth, packed, b, stride_b, c, stride_c);
  if constexpr (N > 1) subtract_last<N - 1>(columns, rows, depth, packed, b, stride_b, c, stride_c);
}

/// `rows` rows of C -= A B, at most `height`; `depth` terms of the sum.
template <int bytes, int height>
BALLAST_IN_LOOP void subtract_rows(int rows, int n, int depth, const double* a,
                                   std::int64_t stride_a, const double* b, std::int64_t stride_b,
                                   double* c, std::int64_t stride_c) {
  Rows<bytes, height> packed[chunk];
  for (int p = 0; p < depth; ++p) packed[p].load(a + p * stride_a, rows);
  int j = 0;
  for (; j + tile_columns <= n; j += tile_columns) {
    subtract_tile<tile_columns>(rows, depth, packed, b, stride_b, c, stride_c);
    b += tile_columns * stride_b;
    c += tile_columns * stride_c;
  }
  subtract_last<tile_columns - 1>(n - j, rows, depth, packed, b, stride_b, c, stride_c);
}

template <int bytes>
BALLAST_IN_LOOP void product_loop(int m, int n, int k, const double* a, std::int64_t stride_a,
                                  const double* b, std::int64_t stride_b, double* c,
                                  std::int64_t stride_c) {
  for (int from = 0; from < k; from += chunk, a += chunk * stride_a) {
    const int depth = std::min(chunk, k - from);
    int i = 0;
    if constexpr (bytes == 64)
      for (; i + tall_rows <= m; i += tall_rows)
        subtract_rows<bytes, tall_rows>(tall_rows, n, depth, a + i, stride_a, b + from, stride_b,
                                        c + i, stride_c);
    for (; i < m; i += tile_rows)
      subtract_rows<bytes, tile_rows>(std::min(tile_rows, m - i), n, depth, a + i, stride_a,
                                      b + from, stride_b, c + i, stride_c);
  }
}

/// N columns of B := L^-1 B with `rows` rows. `l`: L's columns, zero on and above the diagonal.
template <int N, int bytes>
BALLAST_IN_LOOP void solve_tile(int rows, const Rows<bytes>* l, double* b, std::int64_t stride_b) {
  double* column[N];
  Rows<bytes> x[N];
  for (int j = 0; j < N; ++j) {
    column[j] = b + j * stride_b;
    x[j].load(column[j], rows);
  }
  for (int k = 0; k < tile_rows - 1; ++k)
    for (int j = 0; j < N; ++j) {
      const double factor = x[j].part[k / Rows<bytes>::lanes][k % Rows<bytes>::lanes];
      for (int i = 0; i < Rows<bytes>::count; ++i) x[j].part[i] -= l[k].part[i] * factor;
    }
  for (int j = 0; j < N; ++j) x[j].store(column[j], rows);
}

template <int bytes>
BALLAST_IN_LOOP void solve_loop(int rows, int n, const double* l, std::int64_t stride_l, double* b,
                                std::int64_t stride_b) {
  Rows<bytes> packed[tile_rows] = {};
  for (int k = 0; k < rows; ++k) {
    double below[tile_rows] = {};
    for (int i = k + 1; i < rows; ++i) below[i] = l[k * stride_l + i];
    packed[k].load(below, tile_rows);
  }
  int j = 0;
  for (; j + tile_columns <= n; j += tile_columns, b += tile_columns * stride_b)
    solve_tile<tile_columns>(rows, packed, b, stride_b);
  for (; j < n; ++j, b += stride_b) solve_tile<1>(rows, packed, b, stride_b);
}

/// Factors a few columns, one after the other: the entries below the pivot become a column of L,
/// and its product with the pivot's row is subtracted from the later columns.
BALLAST_FOR_EACH_CPU
void factor_tall(double* a, int stride, int rows, int columns) {
  for (int k = 0; k < columns; ++k) {
    double* __restrict pivot_column = a + static_cast<std::int64_t>(k) * stride;
    const double inverse = 1.0 / pivot_column[k];
    for (int i = k + 1; i < rows; ++i) pivot_column[i] *= inverse;
    for (int j = k + 1; j < columns; ++j) {
      double* __restrict column = a + static_cast<std::int64_t>(j) * stride;
      const double factor = column[k];
      for (int i = k + 1; i < rows; ++i) column[i] -= pivot_column[i] * factor;
    }
  }
}

#define BALLAST_KERNELS(name, bytes, target)                                                      \
  target void product_##name(int m, int n, int k, const double* a, int stride_a, const double* b, \
                             int stride_b, double* c, int stride_c) {                             \
    product_loop<bytes>(m, n, k, a, stride_a, b, stride_b, c, stride_c);                          \
  }                                                                                               \
  target void solve_##name(int rows, int n, const double* l, int stride_l, double* b,             \
                           int stride_b) {                                                        \
    solve_loop<bytes>(rows, n, l, stride_l, b, stride_b);                                         \
  }

BALLAST_KERNELS(any, 16, )
#if defined(__x86_64__)
BALLAST_KERNELS(avx2, 32, __attribute__((target("avx2"))))
BALLAST_KERNELS(avx512, 64, __attribute__((target("avx512f"))))
#endif

const DenseKernels& best() {
  static const DenseKernels chosen = dense_kernels().front();
  return chosen;
}

}  // namespace

std::vector<DenseKernels> dense_kernels() {
  std::vector<DenseKernels> sets;
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f")) sets.push_back({"avx512", product_avx512, solve_avx512});
  if (__builtin_cpu_supports("avx2")) sets.push_back({"avx2", product_avx2, solve_avx2});
#endif
  sets.push_back({"any", product_any, solve_any});
  return sets;
}

void subtract_product(int m, int n, int k, const double* a, int stride_a, const double* b,
                      int stride_b, double* c, int stride_c) {
  best().product(m, n, k, a, stride_a, b, stride_b, c, stride_c);
}

void solve_unit_lower(int m, int n, const double* l, int stride_l, double* b, int stride_b) {
  // Tile by tile: solves its rows by substitution, then subtracts their product with L from the
  // rows below in the strip; after the strip's last tile, the strip's product from all other rows.
  for (int s = 0; s < m; s += strip) {
    const int end = std::min(m, s + strip);
    const double* columns = l + static_cast<std::int64_t>(s) * stride_l;
    for (int i = s; i < end; i += tile_rows) {
      const int next = std::min(end, i + tile_rows);
      const double* here = l + static_cast<std::int64_t>(i) * stride_l;
      best().solve(next - i, n, here + i, stride_l, b + i, stride_b);
      subtract_product(end - next, n, next - i, here + next, stride_l, b + i, stride_b, b + next,
                       stride_b);
    }
    subtract_product(m - end, n, end - s, columns + end, stride_l, b + s, stride_b, b + end,
                     stride_b);
  }
}

void factor_columns(double* a, int stride, int rows, int columns) {
  if (columns <= tile_rows) return factor_tall(a, stride, rows, columns);
  // Factors the left part, subtracts its product from the right part and factors the rest of that.
  const int left = tile_rows * ((columns / tile_rows + 1) / 2), right = columns - left;
  factor_columns(a, stride, rows, left);
  double* beside = a + static_cast<std::int64_t>(left) * stride;
  solve_unit_lower(left, right, a, stride, beside, stride);
  subtract_product(rows - left, right, left, a + left, stride, beside, stride, beside + left,
                   stride);
  factor_columns(beside + left, stride, rows - left, right);
}

}  // namespace ballast
