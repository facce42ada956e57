#define AMONTONS_INSTRUCTION_SET baseline
#include "amontons/surface/face_batch_kernel.inc"
