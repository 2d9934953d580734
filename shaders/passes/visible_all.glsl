// Visibility of a sample of the gather (gather_sum.glsl): everything is visible.
bool isVisible(VisibilitySample s) { return true; }
