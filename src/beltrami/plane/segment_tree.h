#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include <beltrami/base/complex.h>
#include <beltrami/base/public.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A closed segment of the plane; a point if both ends are equal.
struct Segment {
    Complex a, b;
};

/// Whether two segments have a point in common, up to the rounding of signed areas. Segments whose bounding boxes are
/// apart never meet, so consecutive pieces of a straight line in any direction are told apart.
bool segments_meet(const Segment& s, const Segment& t);

/// Distance of a point from a segment.
double distance(Complex point, const Segment& segment);

/// Finds the segments near a place: a tree of bounding boxes, halved at the median of the longer side, so that
/// segments of very different lengths cost no more than equal ones. Time n log n to build.
class SegmentTree {
  public:
    struct Box {
        double left = std::numeric_limits<double>::infinity(), right = -left;
        double low = left, high = -left;

        static Box of(const Segment& s) {
            return {std::min(s.a.real(), s.b.real()), std::max(s.a.real(), s.b.real()),
                    std::min(s.a.imag(), s.b.imag()), std::max(s.a.imag(), s.b.imag())};
        }
        bool overlaps(const Box& other) const {
            return left <= other.right && other.left <= right && low <= other.high && other.low <= high;
        }
        void include(const Box& other) {
            left = std::min(left, other.left), right = std::max(right, other.right);
            low = std::min(low, other.low), high = std::max(high, other.high);
        }
    };

    /// @pre all coordinates are finite
    explicit SegmentTree(std::vector<Segment> segments);

    const std::vector<Segment>& segments() const { return segments_; }

    /// Calls visit(index) for every segment whose bounding box overlaps @p box (closed), in no particular but always
    /// the same order.
    template <class Visit>
    void for_each(const Box& box, const Visit& visit) const {
        if (nodes_.empty()) return;
        int stack[64], depth = 0;
        stack[depth++] = 0;
        while (depth) {
            const Node& node = nodes_[stack[--depth]];
            if (!node.box.overlaps(box)) continue;
            if (node.right > 0) {
                stack[depth++] = node.right;
                stack[depth++] = static_cast<int>(&node - nodes_.data()) + 1;
            } else {
                for (int i = node.first; i < node.last; ++i)
                    if (Box::of(segments_[order_[i]]).overlaps(box)) visit(order_[i]);
            }
        }
    }

  private:
    /// The left child of a node follows it.
    struct Node {
        Box box;
        int first, last;  ///< its segments in order_
        int right = 0;    ///< the right child; 0: a leaf
    };

    void build(int first, int last);

    std::vector<Segment> segments_;
    std::vector<int> order_;
    std::vector<Node> nodes_;
};

}  // namespace beltrami
