// Direct solve of a tree of joints (Baraff, "Linear-Time Dynamics using Lagrange Multipliers", SIGGRAPH 1996).
//
// With M the masses of the bodies, J the locked rows and r the velocities that they have to lose, impulses x and
// changes of velocity dv follow from M dv = J^T x, J dv = r. Eliminated from the leaves to the root, every body b first
// and then the joint to its parent p, no entry appears that was not there: with J_b and J_p the joint's rows on either
// body, M_b the body's mass with all below and g_b the impulses from there,
//     S = J_b M_b^-1 J_b^T,   M_p += J_p^T S^-1 J_p,   g_p += J_p^T S^-1 (r - J_b M_b^-1 g_b),
// and back from the root to the leaves
//     x = S^-1 (r - J_b M_b^-1 g_b - J_p dv_p),   dv_b = M_b^-1 (g_b + J_b^T x).
// Rows are those of the iterative passes at one lane.
#define LENDULET_KERNEL_SPACE joints_tree
#include "solver/joints/tree.h"

#include "solver/joints/kernels.inl"

namespace lendulet {
namespace joints_tree {
namespace {

// L D L^T of a lower triangle packed row by row; the diagonal becomes D^-1. Pivots below a millionth of the row's own
// size are noise of the cancellation and are held there.
void factor(float* m, int n) {
    for (int i = 0; i < n; ++i) {
        float* row = m + i * (i + 1) / 2;
        float own = row[i], d = own, v[6];
        for (int j = 0; j < i; ++j) {
            const float* above = m + j * (j + 1) / 2;
            v[j] = row[j];
            for (int k = 0; k < j; ++k) v[j] -= above[k] * v[k];
            row[j] = v[j] * above[j];
            d -= row[j] * v[j];
        }
        d = maximum(d, 1e-6f * own);
        row[i] = d > 0.0f ? 1.0f / d : 0.0f;
    }
}
void solve(const float* m, int n, float* x) {
    for (int i = 1; i < n; ++i)
        for (int j = 0; j < i; ++j) x[i] -= m[i * (i + 1) / 2 + j] * x[j];
    for (int i = n - 1; i >= 0; --i) {
        x[i] *= m[i * (i + 1) / 2 + i];
        for (int j = i + 1; j < n; ++j) x[i] -= m[j * (j + 1) / 2 + i] * x[j];
    }
}
float dot6(const float* a, const float* b) {
    float sum = 0.0f;
    for (int i = 0; i < 6; ++i) sum += a[i] * b[i];
    return sum;
}

// Calls run for the class of a node's joint.
template <class Run>
void with_row(const TreeNode& node, Run&& run) {
    if (node.type == JointClass::ball)
        run(*reinterpret_cast<JointRow<1, JointClass::ball>*>(node.row),
            std::integral_constant<JointClass, JointClass::ball>{});
    else if (node.type == JointClass::hinge)
        run(*reinterpret_cast<JointRow<1, JointClass::hinge>*>(node.row),
            std::integral_constant<JointClass, JointClass::hinge>{});
    else
        run(*reinterpret_cast<JointRow<1, JointClass::fixed>*>(node.row),
            std::integral_constant<JointClass, JointClass::fixed>{});
}
int rows_of(JointClass type) { return type == JointClass::ball ? 3 : type == JointClass::hinge ? 5 : 6; }

template <JointClass C>
void store_pair(const JointRow<1, C>& c, const JointPair<float>& p, SolverBodies& bodies) {
    if (p.A.inverse_mass > 0.0f) store_velocity<1>(bodies.state.data(), c.a, p.A);
    if (p.B.inverse_mass > 0.0f) store_velocity<1>(bodies.state.data(), c.b, p.B);
}

// Rows along `direction` on both bodies: those of A are the negative ones at its own arm.
void put_row(const TreeNode& node, TreeWork& w, int i, Vec3 linear, Vec3 on_a, Vec3 on_b) {
    auto put = [](float* row, Vec3 v, Vec3 t) {
        row[0] = v.x, row[1] = v.y, row[2] = v.z, row[3] = t.x, row[4] = t.y, row[5] = t.z;
    };
    put(node.is_b ? w.own[i] : w.other[i], linear, on_b);
    put(node.is_b ? w.other[i] : w.own[i], -linear, -on_a);
}

template <JointClass C, bool biased>
void begin_joint(const TreeNode& node, TreeWork& w, const JointRow<1, C>& c, const SolverBodies& bodies,
                 const JointConstants& k, bool split) {
    using S = JointShape<C>;
    JointPair<float> pair = load_pair<1, C>(c, bodies);
    JointGeometry<1, C> o = find_geometry<1, C>(c, pair);
    float want[S::locked];
    locked_speeds<1, C, biased>(c, o, pair, k, split, want);
    for (int i = 0; i < S::locked; ++i) w.want[i] = want[i];
    const Vec3 axes[3] = {{1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}};
    for (int i = 0; i < S::linear; ++i) put_row(node, w, i, axes[i], cross(o.ra, axes[i]), cross(o.rb, axes[i]));
    for (int j = 0; j < S::angular; ++j) put_row(node, w, S::linear + j, {}, o.direction[j], o.direction[j]);
}

// The body's own mass; angular part Theta = R diag(principal) R^T.
void put_mass(const TreeNode& node, TreeWork& w, const SolverBodies& bodies) {
    size_t i = static_cast<size_t>(node.body);
    const BodyMotion& m = bodies.motion[i];
    const BodyState& s = bodies.state[i];
    QuatT<float> q =
        multiply(QuatT<float>{s.dq[0], s.dq[1], s.dq[2], s.dq[3]}, QuatT<float>{m.q0[0], m.q0[1], m.q0[2], m.q0[3]});
    SymMat3 I = rotate_diagonal(rotation_matrix<float>(q, 1.0f), Vec3{m.inertia[0], m.inertia[1], m.inertia[2]});
    float mass = 1.0f / s.inverse_mass;
    const float packed[21] = {mass, 0, mass, 0, 0, mass, 0, 0, 0, I.xx, 0, 0, 0, I.xy, I.yy, 0, 0, 0, I.xz, I.yz, I.zz};
    for (int k = 0; k < 21; ++k) w.mass[k] = packed[k];
    for (float& p : w.push) p = 0.0f;
}

// From the leaves to the root.
void eliminate(const TreeNode& node, TreeWork& w, TreeWork* parent) {
    factor(w.mass, 6);
    if (!node.has_joint) return;
    int n = rows_of(node.type);
    for (int i = 0; i < n; ++i) {
        for (int k = 0; k < 6; ++k) w.answer[i][k] = w.own[i][k];
        solve(w.mass, 6, w.answer[i]);
        w.want[i] -= dot6(w.answer[i], w.push);
    }
    float s[21];
    for (int i = 0; i < n; ++i)
        for (int j = 0; j <= i; ++j) s[i * (i + 1) / 2 + j] = dot6(w.own[i], w.answer[j]);
    factor(s, n);
    for (int i = 0; i < 21; ++i) w.rows[i] = s[i];
    if (!parent) return;
    float x[6], column[6];
    for (int i = 0; i < n; ++i) x[i] = w.want[i];
    solve(s, n, x);
    for (int k = 0; k < 6; ++k)
        for (int i = 0; i < n; ++i) parent->push[k] += w.other[i][k] * x[i];
    for (int k = 0; k < 6; ++k) {
        for (int i = 0; i < n; ++i) column[i] = w.other[i][k];
        solve(s, n, column);
        for (int l = k; l < 6; ++l)
            for (int i = 0; i < n; ++i) parent->mass[l * (l + 1) / 2 + k] += w.other[i][l] * column[i];
    }
}

// From the root to the leaves: impulses into `want`, the body's change of velocity into `push`.
void substitute(const TreeNode& node, TreeWork& w, const TreeWork* parent) {
    if (node.has_joint) {
        int n = rows_of(node.type);
        if (parent)
            for (int i = 0; i < n; ++i) w.want[i] -= dot6(w.other[i], parent->push);
        solve(w.rows, n, w.want);
        for (int i = 0; i < n; ++i)
            for (int k = 0; k < 6; ++k) w.push[k] += w.own[i][k] * w.want[i];
    }
    solve(w.mass, 6, w.push);
}

// The largest impulse of a substep at the end of an arm that the body's turning resolves. A body under a pull F at both
// ends swings across it with w^2 = 2 F r / I, and steps of h follow that while h w < 2. In the crack of a whip loads
// exceed it; joints then give way instead of feeding energy in.
float largest_impulse(const SolverBodies& bodies, int32_t body, Vec3 arm, float h) {
    const float* inertia = bodies.motion[static_cast<size_t>(body)].inertia;
    float most = maximum(inertia[0], maximum(inertia[1], inertia[2]));
    float least = minimum(inertia[0], minimum(inertia[1], inertia[2]));
    float middle = ((inertia[0] + inertia[1]) + inertia[2]) - (most + least);
    return middle > 0.0f ? joint_stability * middle / (h * maximum(length(arm), 1e-6f)) : unlimited;
}

template <JointClass C>
void end_joint(const TreeWork& w, JointRow<1, C>& c, SolverBodies& bodies, float h) {
    using S = JointShape<C>;
    JointPair<float> pair = load_pair<1, C>(c, bodies);
    JointGeometry<1, C> o = find_geometry<1, C>(c, pair);
    JointChange<1, C> x;
    float most = minimum(largest_impulse(bodies, c.a[0], o.ra, h), largest_impulse(bodies, c.b[0], o.rb, h));
    float size = length(Vec3{c.impulse[0] + w.want[0], c.impulse[1] + w.want[1], c.impulse[2] + w.want[2]});
    for (int i = 0; i < S::locked; ++i) {
        float total = c.impulse[i] + w.want[i];
        if (i < S::linear && size > most) total = (most / size) * total;
        x.locked[i] = total - c.impulse[i];
        c.impulse[i] = total;
    }
    Vec3 linear, angular;
    to_vectors<1, C>(o, x, linear, angular);
    pair.push(o.ra, o.rb, linear, angular);
    c.turn_a = c.turn_a + (cross(o.ra, linear) + angular);
    c.turn_b = c.turn_b + (cross(o.rb, linear) + angular);
    if constexpr (S::directions > 0) c.angular = c.angular + angular;
    store_pair<C>(c, pair, bodies);
}

}  // namespace
}  // namespace joints_tree

using namespace joints_tree;

bool solves_directly(JointClass type) {
    return type == JointClass::ball || type == JointClass::hinge || type == JointClass::fixed;
}

void solve_tree(const JointTree& tree, const TreeNode* nodes, TreeWork* work, SolverBodies& bodies,
                const JointConstants& k, bool biased) {
    nodes += tree.first;
    work += tree.first;
    for (int i = 0; i < tree.count; ++i) {
        put_mass(nodes[i], work[i], bodies);
        if (!nodes[i].has_joint) continue;
        with_row(nodes[i], [&]<JointClass C>(JointRow<1, C>& c, std::integral_constant<JointClass, C>) {
            JointPair<float> pair = load_pair<1, C>(c, bodies);
            JointGeometry<1, C> o = find_geometry<1, C>(c, pair);
            if (tree.split && k.scale != 1.0f) scale_impulses<1, C>(c, k.scale);
            if (biased || tree.split) rebase<1, C>(c, o, pair);
            store_pair<C>(c, pair, bodies);
        });
    }
    for (int i = 0; i < tree.count; ++i)
        if (nodes[i].has_joint)
            with_row(nodes[i], [&]<JointClass C>(JointRow<1, C>& c, std::integral_constant<JointClass, C>) {
                if (biased) begin_joint<C, true>(nodes[i], work[i], c, bodies, k, tree.split);
                else begin_joint<C, false>(nodes[i], work[i], c, bodies, k, tree.split);
            });
    auto parent = [&](int i) { return nodes[i].parent < 0 ? nullptr : &work[nodes[i].parent]; };
    for (int i = tree.count - 1; i >= 0; --i) eliminate(nodes[i], work[i], parent(i));
    for (int i = 0; i < tree.count; ++i) substitute(nodes[i], work[i], parent(i));
    for (int i = 0; i < tree.count; ++i)
        if (nodes[i].has_joint)
            with_row(nodes[i], [&]<JointClass C>(JointRow<1, C>& c, std::integral_constant<JointClass, C>) {
                end_joint<C>(work[i], c, bodies, k.h);
            });
}

}  // namespace lendulet
