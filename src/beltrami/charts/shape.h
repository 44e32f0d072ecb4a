#pragma once

#include <any>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/charts/circle_domain_chart.h>
#include <beltrami/constraints/prescribed_split.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A surface with its conformal charts, each computed when it is first asked for and then kept: what boundary values,
/// maps and distances of one surface share. May be asked from several threads.
class Shape {
  public:
    /// @param surface kept by reference
    explicit Shape(const Surface& surface);
    Shape(Surface&&) = delete;
    Shape(const Shape&) = delete;

    const Surface& surface() const { return surface_; }

    /// domain_chart(surface(), outer, dirichlet), or the chart that was kept. @throw Error as it does
    const Chart& chart(int outer = 0, const BeltramiSolver* dirichlet = nullptr) const;

    /// circle_domain_chart(surface(), outer). @throw Error as it does
    const CircleDomainChart& circles(int outer = 0) const;

    /// The circle domains that are kept, by their outer loops: to be handed to another program, which keep()s them.
    std::map<int, CircleDomainChart> kept_circles() const;
    /// Keeps a circle domain of this very surface that was computed before; one that is there already stays.
    /// @throw Error bad_option unless it has a place for every vertex
    void keep(CircleDomainChart circles) const;
    /// What is worked out once for this surface and kept under a name: by @p make, when it is first asked for.
    template <class T, class Make>
    const T& once(const std::string& name, const Make& make) const {
        const std::scoped_lock lock(mutex_);
        std::any& kept = once_[name];
        if (!kept.has_value()) kept = T(make());
        return std::any_cast<const T&>(kept);
    }
    /// The same surface where no edge across it joins two boundary vertices (split_bridges); this one if there is no
    /// such edge.
    const Shape& without_bridges() const;
    /// How it was split; nothing if there was no need.
    /// @pre without_bridges() was called
    const std::optional<SplitProblem>& bridges() const { return bridges_; }

  private:
    const Surface& surface_;
    mutable std::recursive_mutex mutex_;
    mutable std::map<int, Chart> charts_;
    mutable std::map<int, CircleDomainChart> circles_;
    mutable std::map<std::string, std::any> once_;
    mutable bool examined_ = false;  ///< for bridges
    mutable std::optional<SplitProblem> bridges_;
    mutable std::unique_ptr<const Surface> split_surface_;
    mutable std::unique_ptr<const Shape> split_;
};

/// That of some shapes whose surface this one is; null if there is none.
const Shape* shape_of(const Surface& surface, const std::vector<const Shape*>& shapes);

/// Its circle domain: the one that its shape among these keeps, else computed for the call.
/// @throw Error as circle_domain_chart
CircleDomainChart circle_domain_of(const Surface& surface, int outer_loop, const std::vector<const Shape*>& shapes);

}  // namespace beltrami
