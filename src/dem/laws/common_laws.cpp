#include "dovetail/dem/laws/common_laws.hpp"

namespace dovetail::dem {

template ContactWork collide(Particles&, PairList&, const PreparedLaws<ElasticLaw>&, double, Booking);
template ContactWork collide(Particles&, PairList&, const PreparedLaws<FrictionalLaw>&, double, Booking);
template ContactWork collide(Particles&, PairList&, const PreparedLaws<HertzLaw>&, double, Booking);
template ContactWork collide(Particles&, PairList&, const PreparedLaws<HertzMindlinLaw>&, double, Booking);

template ContactWork collideWithWall(Particles&, const TriangulatedWall&, WallContacts&,
                                     const PreparedLaws<ElasticLaw>&, double);
template ContactWork collideWithWall(Particles&, const TriangulatedWall&, WallContacts&,
                                     const PreparedLaws<FrictionalLaw>&, double);
template ContactWork collideWithWall(Particles&, const TriangulatedWall&, WallContacts&, const PreparedLaws<HertzLaw>&,
                                     double);
template ContactWork collideWithWall(Particles&, const TriangulatedWall&, WallContacts&,
                                     const PreparedLaws<HertzMindlinLaw>&, double);

}  // namespace dovetail::dem
