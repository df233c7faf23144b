/* Embree, loaded when it is used. After gonio_i_embree_load has succeeded, its
 * functions are called as if it were linked: see core/on_demand.h. */
#ifndef GONIO_EMBREE_LIBRARY_H
#define GONIO_EMBREE_LIBRARY_H

#include <embree3/rtcore.h>

#include "../core/on_demand.h"

#define GONIO_I_EMBREE_SYMBOLS(X)                                                                  \
    X(rtcAttachGeometry)                                                                           \
    X(rtcCommitGeometry)                                                                           \
    X(rtcCommitScene)                                                                              \
    X(rtcGetDeviceError)                                                                           \
    X(rtcIntersect1)                                                                               \
    X(rtcNewDevice)                                                                                \
    X(rtcNewGeometry)                                                                              \
    X(rtcNewScene)                                                                                 \
    X(rtcOccluded1)                                                                                \
    X(rtcReleaseDevice)                                                                            \
    X(rtcReleaseGeometry) X(rtcReleaseScene) X(rtcSetNewGeometryBuffer) X(rtcSetSceneFlags)

struct gonio_i_embree {
    GONIO_I_EMBREE_SYMBOLS(GONIO_I_SYMBOL_POINTER)
};

extern struct gonio_i_embree gonio_i_embree;

gonio_status gonio_i_embree_load(gonio_context *context);

#ifndef GONIO_I_EMBREE_ITSELF
#define rtcAttachGeometry (*gonio_i_embree.rtcAttachGeometry)
#define rtcCommitGeometry (*gonio_i_embree.rtcCommitGeometry)
#define rtcCommitScene (*gonio_i_embree.rtcCommitScene)
#define rtcGetDeviceError (*gonio_i_embree.rtcGetDeviceError)
#define rtcIntersect1 (*gonio_i_embree.rtcIntersect1)
#define rtcNewDevice (*gonio_i_embree.rtcNewDevice)
#define rtcNewGeometry (*gonio_i_embree.rtcNewGeometry)
#define rtcNewScene (*gonio_i_embree.rtcNewScene)
#define rtcOccluded1 (*gonio_i_embree.rtcOccluded1)
#define rtcReleaseDevice (*gonio_i_embree.rtcReleaseDevice)
#define rtcReleaseGeometry (*gonio_i_embree.rtcReleaseGeometry)
#define rtcReleaseScene (*gonio_i_embree.rtcReleaseScene)
#define rtcSetNewGeometryBuffer (*gonio_i_embree.rtcSetNewGeometryBuffer)
#define rtcSetSceneFlags (*gonio_i_embree.rtcSetSceneFlags)
#endif

#endif
