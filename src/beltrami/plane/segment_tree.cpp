#include <beltrami/plane/segment_tree.h>

#include <cmath>
#include <numeric>

#include <beltrami/plane/polygon.h>

namespace beltrami {

bool segments_meet(const Segment& s, const Segment& t) {
    const auto s_box = SegmentTree::Box::of(s), t_box = SegmentTree::Box::of(t);
    if (!s_box.overlaps(t_box)) return false;
    const double t_a = signed_area(s.a, s.b, t.a), t_b = signed_area(s.a, s.b, t.b);
    const double s_a = signed_area(t.a, t.b, s.a), s_b = signed_area(t.a, t.b, s.b);
    if (((t_a > 0 && t_b < 0) || (t_a < 0 && t_b > 0)) && ((s_a > 0 && s_b < 0) || (s_a < 0 && s_b > 0))) return true;
    const auto touches = [](double area, Complex p, const SegmentTree::Box& box) {
        return area == 0 && box.overlaps(SegmentTree::Box::of({p, p}));
    };
    return touches(t_a, t.a, s_box) || touches(t_b, t.b, s_box) || touches(s_a, s.a, t_box) || touches(s_b, s.b, t_box);
}

double distance(Complex point, const Segment& segment) {
    const Complex along = segment.b - segment.a, to = point - segment.a;
    const double length = std::norm(along);
    const double t = length > 0 ? std::clamp(std::real(std::conj(along) * to) / length, 0.0, 1.0) : 0.0;
    return std::abs(to - t * along);
}

SegmentTree::SegmentTree(std::vector<Segment> segments) : segments_(std::move(segments)), order_(segments_.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    nodes_.reserve(segments_.size());
    if (!segments_.empty()) build(0, static_cast<int>(segments_.size()));
}

void SegmentTree::build(int first, int last) {
    constexpr int kLeaf = 4;
    const std::size_t self = nodes_.size();
    Box box;
    for (int i = first; i < last; ++i) box.include(Box::of(segments_[order_[i]]));
    nodes_.push_back({box, first, last});
    if (last - first <= kLeaf) return;
    const bool across = box.right - box.left >= box.high - box.low;
    const auto middle_of = [&](int i) {
        const Complex sum = segments_[i].a + segments_[i].b;
        return across ? sum.real() : sum.imag();
    };
    const int middle = first + (last - first) / 2;
    std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last, [&](int i, int j) {
        const double x = middle_of(i), y = middle_of(j);
        return x != y ? x < y : i < j;
    });
    build(first, middle);
    nodes_[self].right = static_cast<int>(nodes_.size());
    build(middle, last);
}

}  // namespace beltrami
