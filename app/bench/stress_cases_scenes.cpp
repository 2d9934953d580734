#include "app/bench/stress_case_groups.h"

namespace mv::stress {
namespace {

using glm::dvec3;
using glm::vec3;

// ---------------------------------------------------------------- triangles

template <typename Add>
Case shapeCase(const std::string& name, const std::string& why, double factor, Add add) {
    return {name, why,
            [=] {
                World w = litRoom();
                add(w);
                return finished(std::move(w));
            },
            factor};
}

World sceneOf(const std::function<void(World&)>& add) {
    World w;
    add(w);
    return w;
}

// ---------------------------------------------------------------- light

// The room lit by a panel under the ceiling.
Case panelCase(const std::string& name, const std::string& why, double emission, double tolerance) {
    return {
        name, why,
        [=] {
            World w = furnishedRoom();
            w.use(vec3(0.5f), vec3(static_cast<float>(emission)));
            w.quad({1, 3.98, 3}, {2.5, 3.98, 3}, {2.5, 3.98, 4.5}, {1, 3.98, 4.5});
            return finished(std::move(w));
        },
        1.5,
        name == "panel" ? std::nullopt : std::optional<Equality>({"panel", emission, tolerance})};
}

template <typename Add>
Case lightCase(const std::string& name, const std::string& why, double factor, Add add) {
    return {name, why,
            [=] {
                World w = furnishedRoom();
                add(w);
                return finished(std::move(w));
            },
            factor};
}

}  // namespace

void addTriangleCases(std::vector<Case>& all) {
    all.push_back(
        shapeCase("slivers", "triangles 8 m long and a micrometre wide", 1.5, [](World& w) {
            for (std::uint32_t i = 0; i < 60; ++i) {
                const dvec3 a = inRoom(13, 2 * i), b = inRoom(13, 2 * i + 1);
                w.triangle(a, b, b + dvec3(0, 1e-6, 1e-6));
            }
        }));
    all.push_back(
        shapeCase("zero-area", "points and lines among the triangles", 1.05, [](World& w) {
            for (std::uint32_t i = 0; i < 60; ++i) {
                const dvec3 a = inRoom(14, 2 * i), b = inRoom(14, 2 * i + 1);
                w.triangle(a, i % 2 ? a : b, a);
            }
        }));
    all.back().sameAs = Equality{"room", 1, 1e-3};
    all.push_back(shapeCase("collinear", "corners on a line up to rounding: area of rounding alone",
                            1.5, [](World& w) {
                                for (std::uint32_t i = 0; i < 60; ++i) {
                                    const dvec3 a = inRoom(15, 2 * i), b = inRoom(15, 2 * i + 1);
                                    w.triangle(a, a + (b - a) / 3.0, b);
                                }
                            }));
    all.push_back(shapeCase("duplicates", "every triangle five times, sides alternating", 1.5,
                            [](World& w) { w.repeat(4); }));
    all.push_back(shapeCase("coplanar", "sheets of other colours and sizes in the planes of walls",
                            1.5, [](World& w) {
                                w.use({0.2f, 0.7f, 0.2f});
                                w.quad({1, 0, 5}, {7, 0, 5}, {7, 0, 1}, {1, 0, 1});
                                w.use({0.7f, 0.2f, 0.7f}, vec3(0), true);
                                w.quad({2, 0, 4}, {5, 0, 4}, {5, 0, 2}, {2, 0, 2});
                                w.quad({3, 1, 0}, {6, 1, 0}, {6, 3, 0}, {3, 3, 0});
                            }));
    all.push_back(shapeCase("needles", "rods as long as the room, 1 : 100 000", 3.75, [](World& w) {
        for (std::uint32_t i = 0; i < 24; ++i) {
            const dvec3 p = inRoom(16, i);
            dvec3 low = p, high = p + 8e-5;
            const int axis = static_cast<int>(i % 3);
            low[axis] = 0, high[axis] = axis == 0 ? 8 : axis == 1 ? 4 : 6;
            w.box(low, high);
        }
    }));
    all.push_back(shapeCase("antiparallel-normals",
                            "shading normals that cancel in the middle of a triangle", 1.5,
                            [](World& w) {
                                for (int i = 0; i < 12; ++i) {
                                    const dvec3 a(1 + 0.5 * i, 0.4, 1.2);
                                    const vec3 n(0, 0, 1);
                                    w.triangle({a, a + dvec3(0.4, 0, 0), a + dvec3(0.2, 1.5, 0)},
                                               {n, -n, i % 2 ? n : -n});
                                }
                            }));
    all.push_back(shapeCase("thin-shell", "two sheets back to back, a micrometre of the edge apart",
                            2.25, [](World& w) {
                                w.use(vec3(0.6f));
                                w.box({3.9, 0, 0}, {3.9 + 8e-6, 4, 3.2});
                            }));
    all.push_back({"one-triangle", "most nodes and most of the picture are nothing",
                   [] {
                       return finished(sceneOf([](World& w) {
                           w.use(vec3(0.7f), vec3(0), true);
                           w.triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
                           w.pointLight({0.2, 0.2, 1}, 1);
                           w.camera({0.3, 0.3, 1.5}, {0.3, 0.3, 0});
                       }));
                   },
                   1});
    all.push_back({"no-triangle", "nothing to see, to light or to bound",
                   [] {
                       return finished(sceneOf([](World& w) {
                           w.pointLight({0.2, 0.2, 1}, 1);
                           w.camera({0.3, 0.3, 1.5}, {0.3, 0.3, 0});
                       }));
                   },
                   0});
    all.push_back({"only-zero-area", "triangles, and yet no surface",
                   [] {
                       return finished(sceneOf([](World& w) {
                           for (int i = 0; i < 9; ++i) {
                               const dvec3 p(i, 1, 2);
                               w.triangle(p, p, p);
                               w.triangle(p, p + 1.0, p);
                           }
                           w.pointLight({0.2, 0.2, 1}, 1);
                           w.camera({0.3, 0.3, 1.5}, {0.3, 0.3, 0});
                       }));
                   },
                   0});
    all.push_back({"one-point", "a root cube around a single point",
                   [] {
                       return finished(sceneOf([](World& w) {
                           w.triangle(dvec3(5), dvec3(5), dvec3(5));
                           w.pointLight({0.2, 0.2, 1}, 1);
                           w.camera({0.3, 0.3, 1.5}, {5, 5, 5});
                       }));
                   },
                   0});
    all.push_back({"one-plane", "every box of every node is flat",
                   [] {
                       return finished(sceneOf([](World& w) {
                           w.use(vec3(0.7f), vec3(0), true);
                           for (int i = 0; i < 8; ++i)
                               w.quad({i, 0, 8}, {i + 1.5, 0, 8}, {i + 1.5, 0, 0}, {i, 0, 0});
                           w.pointLight({4, 1, 4}, 10);
                           w.camera({4, 5, 10}, {4, 0, 4});
                       }));
                   },
                   1});
    all.push_back({"needle-scene", "a scene of 1 : 100 000: thinner than the lift of VPLs",
                   [] {
                       World world;
                       world.use(vec3(0.7f), vec3(0), true);
                       world.box({0, 0, 0}, {1, 1e-5, 1e-5});
                       world.box({0.4, 0.01, -0.1}, {0.42, 0.02, 0.1});
                       world.camera({0.43, 0.004, 0.005}, {0.4, 0.004, 0});
                       return withViews(std::move(world), [](const RootCube& root, ViewSet& set) {
                           for (std::uint32_t i = 0; i < kUsualViews; ++i)
                               addView(set,
                                       root.rootFromWorld({(i + 0.5) / kUsualViews, 2e-5, 5e-6}),
                                       {0, 1, 0});
                       });
                   },
                   1.25});
    all.push_back({"huge-triangle",
                   "a ground 10 000 times the size of the room upon it",
                   [] {
                       World w = litRoom();
                       w.use(vec3(0.4f));
                       w.triangle({-4e4, -0.5, -4e4}, {0, -0.5, 8e4}, {4e4, -0.5, -4e4});
                       return finished(std::move(w));
                   },
                   18,
                   {},
                   2});  // the room is a tenth of a texel of the sky's maps
}

void addLightCases(std::vector<Case>& all) {
    const std::string range = "fluxes, exposure and means over twelve decades";
    all.push_back(panelCase("panel", "the room lit by an emissive panel", 1, 0));
    all.push_back(panelCase("emission-1e-6", range, 1e-6, 1e-3));
    all.push_back(panelCase("emission-1e6", range, 1e6, 1e-3));
    all.push_back(lightCase(
        "emission-mixed", "a panel of 1e6 beside one of 1e-6 W/(m2 sr)", 1.5, [](World& w) {
            w.use(vec3(0.5f), vec3(1e6f));
            w.quad({1, 3.98, 3}, {2.5, 3.98, 3}, {2.5, 3.98, 4.5}, {1, 3.98, 4.5});
            w.use(vec3(0.5f), vec3(1e-6f));
            w.quad({5, 3.98, 1}, {6, 3.98, 1}, {6, 3.98, 2}, {5, 3.98, 2});
        }));
    all.push_back(
        lightCase("uplight", "a panel 15 cm below the ceiling that shines up", 1.25, [](World& w) {
            w.use(vec3(0.5f), vec3(1));
            w.quad({1, 3.85, 3}, {1, 3.85, 4.5}, {2.5, 3.85, 4.5}, {2.5, 3.85, 3});
        }));
    all.push_back(
        lightCase("uplight-in-leaf", "the panel 2 cm below the ceiling: both in the same leaves",
                  18, [](World& w) {
                      w.use(vec3(0.5f), vec3(1));
                      w.quad({1, 3.98, 3}, {1, 3.98, 4.5}, {2.5, 3.98, 4.5}, {2.5, 3.98, 3});
                  }));
    all.push_back(
        lightCase("light-on-surface", "a lamp at distance zero of the floor", 1.5, [](World& w) {
            w.pointLight({2, 0, 4}, 40);
        }));
    all.push_back(
        lightCase("light-in-corner", "a lamp at the corner of three walls", 2.25, [](World& w) {
            w.pointLight({0, 0, 0}, 40);
        }));
    all.push_back(
        lightCase("light-in-pillar", "a lamp that nothing in sight is lit by", 1.5, [](World& w) {
            w.pointLight({2.9, 2, 2.5}, 40);
        }));
    all.push_back(
        lightCase("black-materials", "no light is reflected: no view lives", 0, [](World& w) {
            w = sceneOf([](World& black) {
                black.use(vec3(0));
                black.box({0, 0, 0}, {8, 4, 6}, true);
                black.pointLight({1.6, 3.2, 4.3}, 40);
                black.camera({0.7, 1.8, 5.5}, {6, 1.1, 2.6});
            });
        }));
    all.push_back(lightCase("no-light", "no emitter at all", 0, [](World&) {}));
    all.push_back({"grazing-sun", "rays along a floor and in the plane of a wall",
                   [] {
                       World w;
                       w.quad({0, 0, 6}, {8, 0, 6}, {8, 0, 0}, {0, 0, 0});
                       w.quad({0, 0, 0}, {8, 0, 0}, {8, 4, 0}, {0, 4, 0});
                       w.box({3.1, 0, 2.2}, {3.7, 4, 2.8});
                       w.sun({0, 0.008, 3}, {8, 0, 3}, 400);
                       w.sun({0, 4, 3}, {0, 0, 3}, 1);
                       w.camera({0.7, 1.8, 5.5}, {6, 1.1, 2.6});
                       return finished(std::move(w));
                   },
                   1.5});
    all.push_back(lightCase("spot-without-angle", "a cone of half angle zero", 1.25, [](World& w) {
        w.spotLight({2, 3, 4}, {2, 0, 4}, 40, 0);
        w.pointLight({1.6, 3.2, 1.8}, 1);
    }));
}

}  // namespace mv::stress
