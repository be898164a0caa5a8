#include "solvers/parts/newton_matrix.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace ballast {
namespace {

/// A dense factorisation of so many rows is faster than looking for zeros.
constexpr int few_rows = 160;
/// Beyond, it is where at least this share of the square is filled, up to so many rows.
constexpr double nearly_full = 0.3;
constexpr int most_dense_rows = 600;

}  // namespace

void NewtonMatrix::prepare(const FrictionProblem& problem) {
  problem_ = &problem;
  operations_ = 0.0;
  has_pattern_ = false;
  cut_into_pieces();
  b_.resize(problem.contact_count());
  place_.resize(problem.row_count());
}

// The rows of a contact are merged column by column; its own columns are there in any case.
void NewtonMatrix::cut_into_pieces() {
  const SparseRows& w = problem_->delassus.w;
  constexpr int none = std::numeric_limits<int>::max();
  pieces_.clear();
  pieces_.reserve(static_cast<size_t>(w.nonZeros()) / 2);
  piece_begin_.assign(1, 0);
  for (int c = 0; c < problem_->contact_count(); ++c) {
    const int first = problem_->row_begin[c], rows = problem_->contact_rows(c);
    std::array<int, 3> at{}, end{};
    for (int i = 0; i < rows; ++i) {
      at[i] = w.outerIndexPtr()[first + i];
      end[i] = w.outerIndexPtr()[first + i + 1];
    }
    int own = first;
    // The rows' columns ascend: the next column is the least among what their heads show.
    for (;;) {
      int column = own < first + rows ? own : none;
      for (int i = 0; i < rows; ++i)
        if (at[i] < end[i]) column = std::min(column, w.innerIndexPtr()[at[i]]);
      if (column == none) break;
      Piece piece{column, 0, {0.0, 0.0, 0.0}};
      for (int i = 0; i < rows; ++i)
        if (at[i] < end[i] && w.innerIndexPtr()[at[i]] == column)
          piece.w[i] = w.valuePtr()[at[i]++];
      own += column == own;
      pieces_.push_back(piece);
    }
    piece_begin_.push_back(static_cast<int>(pieces_.size()));
  }
}

bool NewtonMatrix::solve(const std::vector<ContactLinearisation>& linear,
                         const std::vector<double>& alpha, Impulses& dr) {
  if (!solve_idle(linear, alpha, dr)) return false;
  if (pressed_.empty()) return true;
  const double square = static_cast<double>(pressed_rows_) * pressed_rows_;
  const bool is_full = static_cast<double>(pressed_entries_) > nearly_full * square;
  const bool is_dense = pressed_rows_ <= few_rows || (is_full && pressed_rows_ <= most_dense_rows);
  operations_ = is_dense ? square * pressed_rows_ / 3.0 : 0.0;
  return is_dense ? solve_dense(linear, dr) : solve_sparse(linear, dr);
}

/// The contacts with by_u = 0, and the list of the others.
bool NewtonMatrix::solve_idle(const std::vector<ContactLinearisation>& linear,
                              const std::vector<double>& alpha, Impulses& dr) {
  pressed_.clear();
  pressed_rows_ = 0;
  pressed_entries_ = 0;
  dr.resize(problem_->row_count());
  for (int c = 0; c < problem_->contact_count(); ++c) {
    const ContactLinearisation& l = linear[c];
    const int first = problem_->row_begin[c], rows = problem_->contact_rows(c);
    b_[c] = l.by_r + alpha[c] * l.by_u;
    if (!b_[c].allFinite() || !l.f.allFinite()) return false;
    const bool is_pressed = rows == 3 ? !l.by_u.isZero(0.0) : l.by_u(0, 0) != 0.0;
    for (int i = 0; i < rows; ++i) place_[first + i] = is_pressed ? pressed_rows_ + i : -1;
    if (is_pressed) {
      pressed_.push_back(c);
      pressed_rows_ += rows;
      pressed_entries_ += static_cast<long>(rows) * (piece_begin_[c + 1] - piece_begin_[c]);
    } else if (rows == 3) {
      dr.segment<3>(first) = -(b_[c].inverse() * l.f);
    } else {
      dr[first] = -l.f[0] / b_[c](0, 0);
    }
    if (!is_pressed && !dr.segment(first, rows).allFinite()) return false;
  }
  return true;
}

bool NewtonMatrix::solve_dense(const std::vector<ContactLinearisation>& linear, Impulses& dr) {
  dense_.setZero(pressed_rows_, pressed_rows_);
  right_.resize(pressed_rows_);
  for (const int c : pressed_) {
    const int rows = problem_->contact_rows(c), row = place_[problem_->row_begin[c]];
    Eigen::Vector3d right = -linear[c].f;
    for (int k = piece_begin_[c]; k < piece_begin_[c + 1]; ++k) {
      const Piece& piece = pieces_[k];
      const Eigen::Vector3d scaled =
          linear[c].by_u * Eigen::Vector3d(piece.w[0], piece.w[1], piece.w[2]);
      // The dr of an idle contact is known already and goes to the right-hand side.
      const int column = place_[piece.column];
      if (column < 0)
        right -= scaled * dr[piece.column];
      else
        for (int i = 0; i < rows; ++i) dense_(row + i, column) = scaled[i];
    }
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < rows; ++i) dense_(row + i, row + j) += b_[c](i, j);
    for (int i = 0; i < rows; ++i) right_[row + i] = right[i];
  }
  dense_lu_.compute(dense_);
  solution_ = dense_lu_.solve(right_);
  if (!solution_.allFinite()) return false;
  for (const int c : pressed_) {
    const int first = problem_->row_begin[c];
    for (int i = 0; i < problem_->contact_rows(c); ++i)
      dr[first + i] = solution_[place_[first + i]];
  }
  return true;
}

/// All contacts, so that the pattern stays and is ordered once; idle ones have B alone in their
/// rows.
bool NewtonMatrix::solve_sparse(const std::vector<ContactLinearisation>& linear, Impulses& dr) {
  const int contacts = problem_->contact_count(), all_rows = problem_->row_count();
  if (!has_pattern_) {
    // The pattern column by column from pieces that come contact by contact: how many entries each
    // column has, where it begins, and then the rows in it.
    matrix_.resize(all_rows, all_rows);
    std::vector<int> filled(static_cast<size_t>(all_rows) + 1, 0);
    for (int c = 0; c < contacts; ++c)
      for (int k = piece_begin_[c]; k < piece_begin_[c + 1]; ++k)
        filled[pieces_[k].column + 1] += problem_->contact_rows(c);
    for (int j = 0; j < all_rows; ++j) filled[j + 1] += filled[j];
    matrix_.resizeNonZeros(filled[all_rows]);
    std::copy(filled.begin(), filled.end(), matrix_.outerIndexPtr());
    for (int c = 0; c < contacts; ++c)
      for (int k = piece_begin_[c]; k < piece_begin_[c + 1]; ++k) {
        pieces_[k].offset = filled[pieces_[k].column];
        for (int i = 0; i < problem_->contact_rows(c); ++i)
          matrix_.innerIndexPtr()[filled[pieces_[k].column]++] = problem_->row_begin[c] + i;
      }
    has_pattern_ = true;
  }
  right_.resize(all_rows);
  for (int c = 0; c < contacts; ++c) {
    // by_u times W, piece by piece; B is added where the column is one of the contact's own.
    const int rows = problem_->contact_rows(c), first = problem_->row_begin[c];
    for (int k = piece_begin_[c]; k < piece_begin_[c + 1]; ++k) {
      const Piece& piece = pieces_[k];
      Eigen::Vector3d entries =
          linear[c].by_u * Eigen::Vector3d(piece.w[0], piece.w[1], piece.w[2]);
      if (piece.column >= first && piece.column < first + rows)
        entries += b_[c].col(piece.column - first);
      for (int i = 0; i < rows; ++i) matrix_.valuePtr()[piece.offset + i] = entries[i];
    }
    for (int i = 0; i < rows; ++i) right_[first + i] = -linear[c].f[i];
  }
  if (!sparse_lu_.factor(matrix_)) return false;
  sparse_lu_.solve(matrix_, right_, dr, 1);
  return dr.allFinite();
}

}  // namespace ballast
