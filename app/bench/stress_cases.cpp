#include <cmath>
#include <limits>

#include "app/bench/stress.h"
#include "app/bench/stress_scene.h"
#include "shaders/shared/vpl.glsl"

namespace mv::stress {
namespace {

using glm::dvec3;
using glm::vec3;

constexpr double kAny = std::numeric_limits<double>::infinity();
constexpr int kLevels = 8;
constexpr std::uint32_t kViews = 200;

Settings usual() {
    Settings s;
    s.width = 64;
    s.height = 48;
    s.vpls = kViews;
    s.sceneDepth = s.viewDepth = kLevels;
    return s;
}

Input finished(World world, Settings settings = usual()) {
    return {world.finish(settings.sceneDepth), std::nullopt, settings};
}

// A scene with views of its own: place(root, set) adds them.
template <typename Place>
Input withViews(World world, const Place& place, Settings settings = usual()) {
    Input input = finished(std::move(world), settings);
    place(input.assets->scene.root, input.views.emplace());
    return input;
}

// ---------------------------------------------------------------- scale and place

Case scaled(const std::string& name, double scale, dvec3 offset, double tolerance,
            const std::string& why) {
    return {name, why, [=] { return finished(litRoom(scale, offset)); }, 1.05,
            Equality{"room", 1, tolerance}};
}

// ---------------------------------------------------------------- views

template <typename Place>
Case viewCase(const std::string& name, const std::string& why, double factor, Place place) {
    return {name, why, [=] { return withViews(furnishedRoom(), place); }, factor};
}

// A room with a partition of one double-sided quadrilateral, two sheets a micrometre of the edge
// apart, or of nothing.
World partitionedRoom() {
    World w = furnishedRoom();
    w.use(vec3(0.6f), vec3(0), true);
    w.quad({4.5, 0, 0}, {4.5, 0, 3.2}, {4.5, 4, 3.2}, {4.5, 4, 0});
    return w;
}

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

dvec3 inRoom(std::uint32_t seed, std::uint32_t index) {
    return dvec3(0.3, 0.2, 0.3) + dvec3(randomPoint(seed, index)) * dvec3(7.4, 3.6, 5.4);
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

// ---------------------------------------------------------------- camera and resolutions

Case cameraCase(const std::string& name, const std::string& why, double factor, dvec3 from,
                dvec3 to, double yfovDeg = 62) {
    return {name, why,
            [=] {
                World w = litRoom();
                w.camera(from, to, yfovDeg);
                return finished(std::move(w));
            },
            factor};
}

template <typename Change>
Case settingsCase(const std::string& name, const std::string& why, double factor, Change change) {
    return {name, why,
            [=] {
                Settings s = usual();
                change(s);
                return finished(litRoom(), s);
            },
            factor};
}

Case levelsCase(int sceneLevels, int viewLevels, bool small, double factor,
                const std::string& why) {
    const std::string name = sceneLevels == viewLevels ? "levels-" + std::to_string(sceneLevels)
                                                       : "levels-" + std::to_string(sceneLevels) +
                                                             "-" + std::to_string(viewLevels);
    return {small ? name + "-corridor" : name, why,
            [=] {
                Settings s = usual();
                s.sceneDepth = sceneLevels;
                s.viewDepth = viewLevels;
                return finished(small ? corridor() : litRoom(), s);
            },
            factor};
}

std::vector<Case> makeCases() {
    std::vector<Case> all;
    all.push_back({"room", "the benign case", [] { return finished(litRoom()); }, 1});

    // Scale and place: coordinates of the file must not matter.
    const std::string scale = "lengths in single precision, and areas in powers of them";
    const std::string far = "single precision holds 7 digits, and the distance takes them";
    all.push_back(scaled("scale-2^-13", std::exp2(-13), dvec3(0), 0, scale));
    all.push_back(scaled("scale-2^20", std::exp2(20), dvec3(0), 0, scale));
    all.push_back(scaled("scale-1e-4", 1e-4, dvec3(0), 1e-3, scale));
    all.push_back(scaled("scale-1e6", 1e6, dvec3(0), 1e-3, scale));
    all.push_back(scaled("scale-1e-12", 1e-12, dvec3(0), 1e-3, scale));
    all.push_back(scaled("scale-1e12", 1e12, dvec3(0), 1e-3, scale));
    all.push_back(scaled("offset-2^20", 1, dvec3(std::exp2(20), -std::exp2(19), 4096), 1e-3, far));
    all.push_back(scaled("offset-1e6", 1, dvec3(1e6, -1e6, 1e6), 1e-3, far));
    all.push_back(scaled("offset-1e6-scale-1e-4", 1e-4, dvec3(1e6, 0, -1e6), 0.02,
                         "double precision itself ends at a few units of the root cube's floats"));
    all.push_back({"file-rounded-1e6",
                   "corners kept in single precision 1e6 m away, as a file may: a grid of 6 cm",
                   [] {
                       World w = litRoom(1, dvec3(1e6, 0, 0));
                       w.roundToFloat();
                       return finished(std::move(w));
                   },
                   1.5});

    // Views.
    all.push_back(
        viewCase("one-view", "a tree that is one leaf", 4, [](const RootCube& root, ViewSet& set) {
            addView(set, root.rootFromWorld({2, 3.5, 4}), {0, -1, 0});
        }));
    all.push_back(viewCase("no-views", "empty lists, buffers and means", 0,
                           [](const RootCube&, ViewSet&) {}));
    all.push_back(
        viewCase("dead-views", "every slot of the set is dead", 0,
                 [](const RootCube&, ViewSet& set) { set.views.assign(kViews, vplDead()); }));
    all.push_back(viewCase("coincident", "all views in one point: boxes and radii of size zero", 4,
                           [](const RootCube& root, ViewSet& set) {
                               for (std::uint32_t i = 0; i < kViews; ++i)
                                   addView(set, root.rootFromWorld({2, 2.5, 4}), {0, -1, 0});
                           }));
    all.push_back(
        viewCase("coincident-all-ways", "one point, every direction: no cone", 4,
                 [](const RootCube& root, ViewSet& set) {
                     for (std::uint32_t i = 0; i < kViews; ++i)
                         addView(set, root.rootFromWorld({2, 2.5, 4}), randomDirection(7, i));
                 }));
    all.push_back(viewCase("antiparallel-pairs", "normals that cancel have no mean", 2,
                           [](const RootCube& root, ViewSet& set) {
                               for (std::uint32_t i = 0; i < kViews; ++i)
                                   addView(set, root.rootFromWorld(inRoom(3, i / 2)),
                                           randomDirection(4, i / 2) * (i % 2 ? -1.0f : 1.0f));
                           }));
    all.push_back(viewCase("on-octree-planes",
                           "views on faces, edges and corners of cells of both octrees", 2,
                           [](const RootCube& root, ViewSet& set) {
                               for (std::uint32_t i = 0; set.views.size() < kViews; ++i) {
                                   const vec3 p = root.rootFromWorld(inRoom(5, i));
                                   const float cells = i % 2 ? 8.0f : 128.0f;
                                   vec3 snapped = glm::round(p * cells) / cells;
                                   if (i % 3) snapped.x = p.x;
                                   vec3 n(0);
                                   n[static_cast<int>(i / 2 % 3)] = i % 2 ? 1.0f : -1.0f;
                                   addView(set, snapped, n);
                               }
                           }));
    all.push_back(viewCase("particles", "omnidirectional views see everything, nothing is culled",
                           2, [](const RootCube& root, ViewSet& set) {
                               for (std::uint32_t i = 0; i < kViews; ++i)
                                   addView(set, root.rootFromWorld(inRoom(6, i)), vec3(0));
                           }));
    all.push_back(viewCase(
        "inside-geometry", "views inside the pillar and the chest light nothing", 6,
        [](const RootCube& root, ViewSet& set) {
            for (std::uint32_t i = 0; i < kViews; ++i) {
                const dvec3 r(randomPoint(8, i));
                addView(
                    set,
                    root.rootFromWorld(i % 2 ? dvec3(3.15, 0.1, 2.25) + r * dvec3(0.5, 3.8, 0.5)
                                             : dvec3(5.45, 0.05, 3.45) + r * dvec3(1.2, 1, 1.1)),
                    randomDirection(9, i));
            }
        }));
    all.push_back({"thin-wall",
                   "views on both sides of a wall without thickness, 2e-5 of the edge off it",
                   [] {
                       return withViews(partitionedRoom(), [](const RootCube& root, ViewSet& set) {
                           for (std::uint32_t i = 0; i < kViews; ++i) {
                               const dvec3 r(randomPoint(10, i));
                               const vec3 n(i % 2 ? 1.0f : -1.0f, 0, 0);
                               addView(set,
                                       root.rootFromWorld({4.5, 0.1 + 3.8 * r.y, 0.1 + 3 * r.z}) +
                                           n * kVplOffset,
                                       n);
                           }
                       });
                   },
                   2});
    for (const auto& [name, distance] :
         {std::pair{"facing-wall-1e-6", 1e-6f}, {"facing-wall-1e-3", 1e-3f}}) {
        all.push_back(
            {name, "views that look at a wall from just before it: nothing may pass",
             [distance = distance] {
                 return withViews(partitionedRoom(), [&](const RootCube& root, ViewSet& set) {
                     for (std::uint32_t i = 0; i < kViews; ++i) {
                         const dvec3 r(randomPoint(10, i));
                         const vec3 n(i % 2 ? 1.0f : -1.0f, 0, 0);
                         addView(set,
                                 root.rootFromWorld({4.5, 0.1 + 3.8 * r.y, 0.1 + 3 * r.z}) +
                                     n * distance,
                                 -n);
                     }
                 });
             },
             2});
    }
    all.push_back(viewCase("on-the-surface", "views not lifted off their wall: at distance zero", 2,
                           [](const RootCube& root, ViewSet& set) {
                               for (std::uint32_t i = 0; i < kViews; ++i) {
                                   dvec3 p = inRoom(11, i);
                                   p.y = i % 2 ? 0 : 4;
                                   addView(set, root.rootFromWorld(p), {0, i % 2 ? 1 : -1, 0});
                               }
                           }));
    all.push_back(viewCase("at-the-cube's-corners", "keys at both ends of every axis", 10,
                           [](const RootCube&, ViewSet& set) {
                               for (std::uint32_t i = 0; i < 27; ++i) {
                                   const vec3 p = vec3(static_cast<float>(i % 3),
                                                       static_cast<float>(i / 3 % 3),
                                                       static_cast<float>(i / 9)) *
                                                  0.5f;
                                   if (p != vec3(0.5f))
                                       addView(set, p, glm::normalize(vec3(0.5f) - p));
                               }
                               addView(set, vec3(0.3f, 0.6f, 0.6f), {0, -1, 0});
                           }));
    all.push_back(viewCase(
        "outside-the-cube", "views where no cell is, and all the scene in a few texels", 20,
        [](const RootCube&, ViewSet& set) {
            for (std::uint32_t i = 0; i < 40; ++i)
                addView(set, vec3(0.5f) + 3.0f * randomDirection(12, i), -randomDirection(12, i));
            addView(set, vec3(0.3f, 0.6f, 0.6f), {0, -1, 0});
        }));

    // Triangles.
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
    all.push_back(shapeCase("needles", "rods as long as the room, 1 : 100 000", 2, [](World& w) {
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
                            3, [](World& w) {
                                w.use(vec3(0.6f));
                                w.box({4.5, 0, 0}, {4.5 + 8e-6, 4, 3.2});
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
    all.push_back(
        {"needle-scene", "a scene of 1 : 100 000: thinner than the lift of VPLs",
         [] {
             World world;
             world.use(vec3(0.7f), vec3(0), true);
             world.box({0, 0, 0}, {1, 1e-5, 1e-5});
             world.box({0.4, 0.01, -0.1}, {0.42, 0.02, 0.1});
             world.camera({0.43, 0.004, 0.005}, {0.4, 0.004, 0});
             return withViews(std::move(world), [](const RootCube& root, ViewSet& set) {
                 for (std::uint32_t i = 0; i < kViews; ++i)
                     addView(set, root.rootFromWorld({(i + 0.5) / kViews, 2e-5, 5e-6}), {0, 1, 0});
             });
         },
         2});
    all.push_back({"huge-triangle", "a ground 10 000 times the size of the room upon it",
                   [] {
                       World w = litRoom();
                       w.use(vec3(0.4f));
                       w.triangle({-4e4, -0.5, -4e4}, {0, -0.5, 8e4}, {4e4, -0.5, -4e4});
                       return finished(std::move(w));
                   },
                   12});

    // Light.
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
        lightCase("uplight", "a panel 15 cm below the ceiling that shines up", 3, [](World& w) {
            w.use(vec3(0.5f), vec3(1));
            w.quad({1, 3.85, 3}, {1, 3.85, 4.5}, {2.5, 3.85, 4.5}, {2.5, 3.85, 3});
        }));
    all.push_back(
        lightCase("uplight-in-leaf", "the panel 2 cm below the ceiling: both in the same leaves",
                  20, [](World& w) {
                      w.use(vec3(0.5f), vec3(1));
                      w.quad({1, 3.98, 3}, {1, 3.98, 4.5}, {2.5, 3.98, 4.5}, {2.5, 3.98, 3});
                  }));
    all.push_back(
        lightCase("light-on-surface", "a lamp at distance zero of the floor", 2, [](World& w) {
            w.pointLight({2, 0, 4}, 40);
        }));
    all.push_back(
        lightCase("light-in-corner", "a lamp at the corner of three walls", 2, [](World& w) {
            w.pointLight({0, 0, 0}, 40);
        }));
    all.push_back(
        lightCase("light-in-pillar", "a lamp that nothing in sight is lit by", 3, [](World& w) {
            w.pointLight({3.4, 2, 2.5}, 40);
        }));
    all.push_back(
        lightCase("black-materials", "no light is reflected: no view lives", 0, [](World& w) {
            w = sceneOf([](World& black) {
                black.use(vec3(0));
                black.box({0, 0, 0}, {8, 4, 6}, true);
                black.pointLight({1.6, 3.2, 4.3}, 40);
                black.camera({0.7, 1.8, 5.3}, {5.6, 1.1, 2.2});
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
                       w.camera({0.7, 1.8, 5.3}, {5.6, 1.1, 2.2});
                       return finished(std::move(w));
                   },
                   2});
    all.push_back(lightCase("spot-without-angle", "a cone of half angle zero", 2, [](World& w) {
        w.spotLight({2, 3, 4}, {2, 0, 4}, 40, 0);
        w.pointLight({1.6, 3.2, 4.3}, 1);
    }));

    // Cameras.
    all.push_back(cameraCase("looking-down", "forward along up", 2, {2, 3.5, 4}, {2, 0, 4}));
    all.push_back(cameraCase("in-the-wall", "the camera in the plane of a wall, looking along it",
                             2, {0, 2, 3}, {0, 1, 0}));
    all.push_back(cameraCase("inside-pillar", "surfaces nearer than any feature, seen from behind",
                             4, {3.4, 2, 2.5}, {6, 1, 2}));
    all.push_back(cameraCase("nose-on-floor", "a camera 1e-5 of the edge above the floor", 4,
                             {4, 8e-5, 4.5}, {6, 0, 2}));
    all.push_back(
        cameraCase("far-away", "the whole scene in one pixel", 4, {60, 25, 110}, {4, 2, 3}));
    all.push_back(cameraCase("fov-0.1", "a telescope", 4, {0.7, 1.8, 5.3}, {5.6, 1.1, 2.2}, 0.1));
    all.push_back(cameraCase("fov-170", "pixels of very different angles", 2, {0.7, 1.8, 5.3},
                             {5.6, 1.1, 2.2}, 170));
    all.push_back(cameraCase("nothing-in-sight", "means over no pixel", 0, {-5, 2, 3}, {-9, 2, 3}));

    // Resolutions.
    all.push_back(settingsCase("one-pixel", "a picture of one pixel", 4,
                               [](Settings& s) { s.width = s.height = 1; }));
    all.push_back(
        settingsCase("view-res-8", "texels of 30 degrees", 3, [](Settings& s) { s.viewRes = 8; }));
    all.push_back(
        settingsCase("view-res-256", "texels below the leaves: holes", 3, [](Settings& s) {
            s.viewRes = 256;
            s.vpls = 4;
        }));
    all.push_back(settingsCase("clamp-0", "the geometry term without its clamp", 2,
                               [](Settings& s) { s.clampDistance = 0; }));
    all.push_back(levelsCase(1, 1, false, 4, "both octrees are their roots: no visibility left"));
    all.push_back(levelsCase(2, 2, false, 25, "leaves of half the room"));
    all.push_back(levelsCase(3, 3, false, 20, "leaves of 2 m"));
    all.push_back(levelsCase(4, 4, false, 2, "leaves of 1 m"));
    all.push_back(levelsCase(5, 5, false, 2, "leaves of 0.5 m"));
    all.push_back(levelsCase(6, 6, false, 2, "leaves of 26 cm"));
    all.push_back(levelsCase(7, 7, false, 1.5, "leaves of 13 cm"));
    all.push_back(levelsCase(9, 9, false, 1.5, "leaves of 3 cm"));
    all.push_back(levelsCase(8, 1, false, 10, "one view leaf at the root"));
    all.push_back(levelsCase(1, 8, false, 4, "one scene leaf at the root"));
    all.push_back(levelsCase(8, 8, true, 4, "the corridor that deeper octrees are held against"));
    all.push_back(levelsCase(10, 10, true, 4, "leaves of 16 mm"));
    all.push_back(levelsCase(11, 11, true, 4, "all 30 bits of the keys"));
    return all;
}

}  // namespace

const std::vector<Case>& cases() {
    static const std::vector<Case> all = makeCases();
    return all;
}

}  // namespace mv::stress
