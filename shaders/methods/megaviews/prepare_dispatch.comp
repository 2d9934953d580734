// The indirect command for as many work groups as a counter of the status buffer asks for, folded
// into two dimensions; none after an overflow, since the frame starts again anyway.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/traversal_data.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(std430, binding = kBlockStatus) restrict readonly buffer StatusBuffer { uint status[]; };
layout(std430, binding = kBlockCommand) restrict writeonly buffer CommandBuffer { uint command[]; };

uniform uint statusIndex;
uniform uint capacity;
uniform uint perGroup;  // entries

void main() {
    if (globalIndex() != 0u) return;
    uint entries = status[kStatusOverflow] != 0u ? 0u : min(status[statusIndex], capacity);
    uint groups = (entries + perGroup - 1u) / perGroup;
    uint columns = min(groups, 65535u);
    command[0] = columns;
    command[1] = columns == 0u ? 0u : (groups + columns - 1u) / columns;
    command[2] = 1u;
}
