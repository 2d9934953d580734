#pragma once
// Building parts for the scenes made by code: arches, vaults, columns, balusters and cloth, each
// placed by the builder's current frame, material and tint.

#include "megaviews/scene/builtin_mesh.h"

namespace mv::builtin {

// Half an arch is a circular arc through `apexTurns` of a circle: a quarter turn makes it round,
// less makes it pointed (1/6: equilateral). For half-span 1; x runs from -1 to 1.
struct Arch {
    double apexTurns = 0.25;
    double radius() const { return 1 / (1 - cosTurns(apexTurns)); }
    double rise() const { return radius() * sinTurns(apexTurns); }
    // Point s in [0,1] along the arch, evenly by angle on each half, from (-1, 0) to (1, 0).
    glm::dvec2 point(double s) const;
};

// A wall in the plane z = 0, from x0 to x1 and bottom to top, `thickness` deep around the plane,
// with an arched opening of half-span `half` centred between x0 and x1 that springs at `spring`
// and reaches down to `bottom`. Faces and reveals, no outer edges. `moulding` > 0 adds an
// archivolt of that width on both faces.
struct ArchWall {
    double x0, x1, bottom, top, thickness;
    double half, spring;
    Arch arch;
    int steps = 24;  // even
    double moulding = 0;
};
void archWall(MeshBuilder& mesh, const ArchWall& wall);

// A moulding along an arch in the plane z = 0 around x = 0, springing at y = 0: rectangular in
// section, from half-span `half` outwards by `width`, `depth` deep around z = 0.
void archRib(MeshBuilder& mesh, Arch arch, double half, double rise, double width, double depth,
             int steps);

// A groin vault over [-hx,hx] x [-hz,hz] springing at y = 0: two crossing barrels of one profile
// whose crowns are `rise` high; ribs along the groins if ribWidth > 0. Seen from below.
void groinVault(MeshBuilder& mesh, Arch arch, double hx, double hz, double rise, int steps);
void groinRibs(MeshBuilder& mesh, Arch arch, double hx, double hz, double rise, double width,
               double depth, int steps);

// A column standing on y = 0 with square plinth, torus base, shaft with entasis, bell capital and
// abacus; flutes = 0 leaves the shaft smooth. `height` is that of the abacus' top.
struct Column {
    double height, radius;
    int flutes = 16, segmentsPerFlute = 4, rings = 8;
};
void column(MeshBuilder& mesh, const Column& column);

void baluster(MeshBuilder& mesh, double height, double radius, int segments);

// A rail, base and balusters along x from x0 to x1, around z = 0 and on y = 0.
void balustrade(MeshBuilder& mesh, double x0, double x1, double height, int balusters);

// Cloth hanging from a rod along x at y = 0, `width` wide and `height` long, gathered at a tie
// towards one side (-1, +1) or falling freely (0). One sheet; its material is double-sided.
struct Curtain {
    double width, height;
    int side = 0;
    int folds = 7;
    double depth = 0.09;  // of the folds
    double phase = 0;     // turns: makes neighbours differ
    int columns = 48, rows = 20;
};
void curtain(MeshBuilder& mesh, const Curtain& curtain);

// A long cloth lying over a rail at y = 0 and hanging down `front` metres before it (+z) and
// `back` behind it.
void drape(MeshBuilder& mesh, double width, double front, double back, double rail, double phase);

}  // namespace mv::builtin
