#include "geometry/shape/qhull_loops.hpp"

#include <libqhull_r/qhull_ra.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <sstream>
#include <string>
#include <utility>

#include "geometry/shape/invalid_polyhedron.hpp"

namespace ballast {
namespace {

/// A message stream in memory: qhull writes its complaints there instead of to stderr.
class Messages {
 public:
  Messages() : file_(open_memstream(&text_, &length_)) {
    if (!file_) throw std::bad_alloc();
  }
  ~Messages() {
    std::fclose(file_);
    std::free(text_);
  }
  Messages(const Messages&) = delete;
  Messages& operator=(const Messages&) = delete;
  FILE* file() { return file_; }

 private:
  char* text_ = nullptr;
  size_t length_ = 0;
  FILE* file_;
};

/// One qhull run and its memory.
class QhullRun {
 public:
  QhullRun(std::vector<double>& coordinates, double merge) {
    qh_zero(&qh_, messages_.file());
    std::ostringstream command;
    command << "qhull Pp E" << merge;  // Pp: no warnings about precision
    std::string text = command.str();  // qhull wants it writable
    const int code =
        qh_new_qhull(&qh_, 3, static_cast<int>(coordinates.size() / 3), coordinates.data(), False,
                     text.data(), nullptr, messages_.file());
    if (code != qh_ERRnone) {
      release();
      // What qhull says is written for its own users.
      throw InvalidPolyhedron("their hull is thinner than its numbers are exact");
    }
  }
  ~QhullRun() { release(); }
  QhullRun(const QhullRun&) = delete;
  QhullRun& operator=(const QhullRun&) = delete;

  /// Vertex loops of the merged facets, in qhull's order of facets; orientation and starting vertex
  /// as they come.
  Loops loops() {
    Loops result;
    qhT* qh = &qh_;  // the name that qhull's macros expect
    facetT* facet;
    FORALLfacets { result.push_back(loop(facet)); }
    return result;
  }

 private:
  /// qhull keeps two stores: large blocks, and a pool of small ones that is freed by itself.
  void release() {
    qh_freeqhull(&qh_, !qh_ALL);
    int blocks, bytes;
    qh_memfreeshort(&qh_, &blocks, &bytes);
  }

  std::vector<int> loop(facetT* facet) {
    qhT* qh = &qh_;
    std::vector<int> vertices;
    vertexT *vertex, **vertexp;
    FOREACHvertex_(facet->vertices) vertices.push_back(qh_pointid(qh, vertex->point));
    if (facet->simplicial) return vertices;
    // a merged facet's vertices are unordered: chain its ridges, which are its edges in 3-d
    std::vector<std::pair<int, int>> links;
    ridgeT *ridge, **ridgep;
    FOREACHridge_(facet->ridges) {
      links.emplace_back(qh_pointid(qh, SETfirstt_(ridge->vertices, vertexT)->point),
                         qh_pointid(qh, SETsecondt_(ridge->vertices, vertexT)->point));
    }
    // From corner to corner along the ridge that does not lead back, until the loop closes.
    std::vector<int> chain{links.front().first};
    for (int at = links.front().second; at != chain.front();) {
      chain.push_back(at);
      const auto next = std::find_if(links.begin(), links.end(), [&](const auto& link) {
        const int previous = chain[chain.size() - 2];
        return (link.first == at && link.second != previous) ||
               (link.second == at && link.first != previous);
      });
      if (next == links.end() || chain.size() > links.size()) {
        throw InvalidPolyhedron("a face of the hull is no simple loop");
      }
      at = next->first == at ? next->second : next->first;
    }
    return chain;
  }

  Messages messages_;
  qhT qh_;
};

}  // namespace

Loops qhull_loops(std::vector<double>& coordinates, double merge) {
  return QhullRun(coordinates, merge).loops();
}

}  // namespace ballast
