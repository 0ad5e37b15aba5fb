// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/mcnp/transformation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "exactcsg/domain/vector.hpp"
#include "exactcsg/io/openscad/degree_trigonometry.hpp"

namespace exactcsg::io::mcnp {

namespace {

using domain::detail::scalar_product;
using domain::detail::vector_product;
using Matrix = std::array<std::array<Rational, 3>, 3>;
using Row = std::array<double, 3>;

// How far a product of rows of a matrix may be from that of a rotation.
constexpr double least_orthogonal = 1e-2;

bool is_orthogonal(const Matrix& m) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = i; j < 3; ++j) {
      if (scalar_product(m[i], m[j]) != (i == j ? 1 : 0)) return false;
    }
  }
  return true;
}

double dot(const Row& a, const Row& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Row cross(const Row& a, const Row& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Row normalised(Row row) {
  const double length = std::sqrt(dot(row, row));
  for (double& x : row) x /= length;
  return row;
}

// The unit quaternion of a rotation, from its greatest component: w, x, y, z.
std::array<double, 4> quaternion_of(const std::array<Row, 3>& m) {
  const double trace = m[0][0] + m[1][1] + m[2][2];
  std::array<double, 4> q{};
  std::size_t greatest = 3;
  for (std::size_t i = 0; i < 3; ++i) {
    if (greatest == 3 ? m[i][i] > trace : m[i][i] > m[greatest][greatest]) greatest = i;
  }
  if (greatest == 3) {
    q = {1 + trace, m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]};
  } else {
    const std::size_t i = greatest;
    const std::size_t j = (i + 1) % 3;
    const std::size_t k = (i + 2) % 3;
    q[0] = m[k][j] - m[j][k];
    q[1 + i] = 1 + m[i][i] - m[j][j] - m[k][k];
    q[1 + j] = m[i][j] + m[j][i];
    q[1 + k] = m[i][k] + m[k][i];
  }
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  for (double& x : q) x /= length;
  return q;
}

// A rotation for any rational quaternion but 0: that is how it is orthogonal without a rounding.
Matrix rotation_of(const std::array<double, 4>& quaternion) {
  std::array<Rational, 4> q;
  for (std::size_t i = 0; i < 4; ++i) q[i] = rational_of(quaternion[i]);
  const Rational norm = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  Matrix m;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const std::size_t k = (i + 2) % 3;
    const Rational &a = q[1 + i], &b = q[1 + j], &c = q[1 + k];
    m[i][i] = (q[0] * q[0] + a * a - b * b - c * c) / norm;
    m[i][j] = 2 * (a * b - q[0] * c) / norm;
    m[i][k] = 2 * (a * c + q[0] * b) / norm;
  }
  return m;
}

// nullopt: the rows are far from orthogonal, or not of length 1.
std::optional<Matrix> orthogonal_near(const Matrix& given) {
  std::array<Row, 3> rows{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) rows[i][j] = nearest_double(given[i][j]);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = i; j < 3; ++j) {
      const double error = dot(rows[i], rows[j]) - (i == j ? 1 : 0);
      if (!(std::abs(error) < least_orthogonal)) return std::nullopt;
    }
  }
  const double turn = dot(cross(rows[0], rows[1]), rows[2]) > 0 ? 1 : -1;
  rows[0] = normalised(rows[0]);
  const double along = dot(rows[0], rows[1]);
  for (std::size_t i = 0; i < 3; ++i) rows[1][i] -= along * rows[0][i];
  rows[1] = normalised(rows[1]);
  rows[2] = cross(rows[0], rows[1]);
  if (turn < 0) {
    for (std::size_t i = 0; i < 2; ++i) {
      for (double& x : rows[i]) x = -x;
    }
  }
  Matrix result = rotation_of(quaternion_of(rows));
  if (turn < 0) {
    for (auto& row : result) {
      for (Rational& x : row) x = -x;
    }
  }
  return result;
}

Rational cosine_of(const Card& card, const Entry& entry) {
  const double degrees = nearest_double(*entry.value);
  if (!(std::abs(degrees) <= 360)) {
    card.fail(ErrorId::NumberOutOfRange, fmt::format("the angle '{}'", entry.word.text),
              "degrees from 0 to 180", entry.word.at);
  }
  return rational_of(openscad::cosine_of_degrees(degrees));
}

class TransformationReader {
 public:
  TransformationReader(const Card& card, const std::vector<Entry>& entries, bool is_in_degrees)
      : card_(card), entries_(entries), is_in_degrees_(is_in_degrees) {}

  Transformation read() const {
    if (entries_.size() > 13) {
      card_.fail(ErrorId::WrongCount, fmt::format("{} numbers", entries_.size()),
                 "a displacement, a matrix and M: at most 13", entries_[13].word.at);
    }
    Transformation result;
    Matrix rows = read_matrix(result.is_rounded);
    std::array<Rational, 3> origin;
    for (std::size_t i = 0; i < std::min<std::size_t>(3, entries_.size()); ++i) {
      if (entries_[i].value) origin[i] = *entries_[i].value;
    }
    // main = O + rows^T auxiliary, or auxiliary = rows main + O.
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) result.to_main.m[i][j] = rows[j][i];
      result.to_main.m[i][3] = origin[i];
      if (!is_origin_of_main()) continue;
      result.to_main.m[i][3] = 0;
      for (std::size_t j = 0; j < 3; ++j) result.to_main.m[i][3] -= rows[j][i] * origin[j];
    }
    return result;
  }

 private:
  bool is_origin_of_main() const {
    if (entries_.size() < 13 || !entries_[12].value || *entries_[12].value == 1) return false;
    if (*entries_[12].value == -1) return true;
    card_.fail(ErrorId::BadArgument, fmt::format("M = '{}'", entries_[12].word.text), "1 or -1",
               entries_[12].word.at);
  }

  Matrix read_matrix(bool& is_rounded) const {
    const std::size_t end = std::min<std::size_t>(12, entries_.size());
    std::vector<const Entry*> given;
    for (std::size_t i = 3; i < end; ++i) {
      if (entries_[i].value) given.push_back(&entries_[i]);
    }
    Matrix rows;
    if (given.empty()) {
      for (std::size_t i = 0; i < 3; ++i) rows[i][i] = 1;
      return rows;
    }
    check_pattern(given, end);
    for (std::size_t i = 0; i < given.size(); ++i) {
      rows[i / 3][i % 3] = is_in_degrees_ ? cosine_of(card_, *given[i]) : *given[i]->value;
    }
    if (given.size() == 6) rows[2] = vector_product(rows[0], rows[1]);
    if (is_orthogonal(rows)) return rows;
    is_rounded = true;
    const std::optional<Matrix> near = orthogonal_near(rows);
    if (!near) {
      card_.fail(ErrorId::BadArgument, "a matrix that is no rotation",
                 "rows of length 1 at right angles to each other", given.front()->word.at);
    }
    return *near;
  }

  // All nine, or two whole rows.
  void check_pattern(const std::vector<const Entry*>& given, std::size_t end) const {
    const bool are_first = given.size() + 3 == end || given.size() == 9 ||
                           (given.size() == 6 && given.back() == &entries_[8]);
    if (are_first && (given.size() == 9 || given.size() == 6)) return;
    if (given.size() == 3 || given.size() == 5 || given.size() == 6) {
      card_.fail(ErrorId::UnsupportedNode,
                 fmt::format("a matrix of {} numbers of nine", given.size()),
                 "all nine, or the first six", given.front()->word.at);
    }
    card_.fail(ErrorId::WrongCount, fmt::format("a matrix of {} numbers", given.size()),
               "nine, or the first six", given.front()->word.at);
  }

  const Card& card_;
  const std::vector<Entry>& entries_;
  bool is_in_degrees_;
};

}  // namespace

Transformation transformation_of(const Card& card, const std::vector<Entry>& entries,
                                 bool is_in_degrees) {
  return TransformationReader(card, entries, is_in_degrees).read();
}

}  // namespace exactcsg::io::mcnp
