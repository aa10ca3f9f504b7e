// Generated from ComputeShaders/dq_skinning.compute by tools/gen_wgsl.py; do not edit.

/** @type {import("../shader.js").Shader} */
export const BlendVertices = {
  ...{"stage":"comp","entry":"BlendVertices","buffers":[{"name":"joints","binding":0,"read_only":true,"scalar":"float","stride":16},{"name":"indices","binding":1,"read_only":true,"scalar":"uint","stride":4},{"name":"weights","binding":2,"read_only":true,"scalar":"float","stride":4},{"name":"vertex_dq","binding":3,"read_only":false,"scalar":"float","stride":16}],"constants":[{"name":"vertex_count","offset":0,"scalar":"uint","shape":[],"strides":[],"used":true}],"constants_binding":4,"threads":[64,1,1]},
  code: `struct Constants{@align(16)vertex_count_0:u32,};
@binding(4)@group(0)var<uniform>Constants_0:Constants;
@binding(1)@group(0)var<storage,read>indices_0:array<u32>;
@binding(0)@group(0)var<storage,read>joints_0:array<vec4f>;
@binding(2)@group(0)var<storage,read>weights_0:array<f32>;
@binding(3)@group(0)var<storage,read_write>vertex_dq_0:array<vec4f>;
struct DualQuaternion_0{real_0:vec4f,dual_0:vec4f,};
fn noTransform_0()->DualQuaternion_0{var a:DualQuaternion_0;var b=vec4f();a.real_0=b;a.dual_0=b;return a;}
fn accumulate_0(a:DualQuaternion_0,b:vec4f,c:vec4f,d:f32,e:vec4f)->DualQuaternion_0{var f=a;var g:f32;if(dot(b,e)<0f){g=-d;}else{g=d;}f.real_0=f.real_0+vec4f(g)*b;f.dual_0=f.dual_0+vec4f(g)*c;return f;}
fn normalized_0(a:DualQuaternion_0)->DualQuaternion_0{var b=a;var c=vec4f(max(length(b.real_0),1.1754944e-38f));b.real_0=b.real_0/c;b.dual_0=b.dual_0/c;return b;}
@compute@workgroup_size(64,1,1)fn BlendVertices(@builtin(global_invocation_id)a:vec3u){var b=a.x;if(b>=Constants_0.vertex_count_0){return;}var c=8u*b;var d=joints_0[2*indices_0[c]];var e=noTransform_0();var f=c;for(;f<(8u*(b+1u));){var g=accumulate_0(e,joints_0[2*indices_0[f]],joints_0[2*indices_0[f]+1u],weights_0[f],d);var h=f+1u;e=g;f=h;}var i=normalized_0(e);var j=2u*b;vertex_dq_0[j]=i.real_0;vertex_dq_0[j+1u]=i.dual_0;}`,
};
