// The laws that most scenes use, compiled once, in the library, with the flags that make their loops vectors. A program
// that includes this header neither compiles them again nor needs flags of its own. All other laws are compiled where
// they are used; there -O3 -fno-math-errno lets their loops vectorise.
#pragma once

#include "dovetail/dem/laws/hertz_mindlin.hpp"
#include "dovetail/dem/pairs/pair_collide.hpp"
#include "dovetail/dem/walls/wall_collide.hpp"

namespace dovetail::dem {

extern template ContactWork collide(Particles&, PairList&, const PreparedLaws<ElasticLaw>&, double, Booking);
extern template ContactWork collide(Particles&, PairList&, const PreparedLaws<FrictionalLaw>&, double, Booking);
extern template ContactWork collide(Particles&, PairList&, const PreparedLaws<HertzLaw>&, double, Booking);
extern template ContactWork collide(Particles&, PairList&, const PreparedLaws<HertzMindlinLaw>&, double, Booking);

extern template ContactWork collideWithWall(Particles&, const TriangulatedWall&, WallContacts&,
                                            const PreparedLaws<ElasticLaw>&, double, Booking);
extern template ContactWork collideWithWall(Particles&, const TriangulatedWall&, WallContacts&,
                                            const PreparedLaws<FrictionalLaw>&, double, Booking);
extern template ContactWork collideWithWall(Particles&, const TriangulatedWall&, WallContacts&,
                                            const PreparedLaws<HertzLaw>&, double, Booking);
extern template ContactWork collideWithWall(Particles&, const TriangulatedWall&, WallContacts&,
                                            const PreparedLaws<HertzMindlinLaw>&, double, Booking);

}  // namespace dovetail::dem
