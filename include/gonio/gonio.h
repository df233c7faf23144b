/* gonio: plan BRDF measurements and complete them. Includes every stage, in pipeline order. */
#ifndef GONIO_GONIO_H
#define GONIO_GONIO_H

#include <gonio/status.h>
#include <gonio/context.h>
#include <gonio/direction.h>
#include <gonio/metric.h>
#include <gonio/atlas.h>
#include <gonio/material.h>
#include <gonio/database.h>
#include <gonio/basis.h>
#include <gonio/instrument.h>
#include <gonio/plan.h>
#include <gonio/measurement.h>
#include <gonio/reconstruct.h>
#include <gonio/evaluate.h>
#include <gonio/render.h>
#include <gonio/file.h>
#include <gonio/page.h>

#endif
