// Generated from ComputeShaders/expressions.compute by tools/gen_wgsl.py; do not edit.

import { withLines } from "../shader.js";
import { UpsampleTexels } from "./inverse_dwt.js";

/** @type {import("../shader.js").Shader} */
export const SumTargets = {
  ...{"stage":"comp","entry":"SumTargets","buffers":[{"name":"vertices","binding":0,"read_only":true,"scalar":"uint","stride":4},{"name":"starts","binding":1,"read_only":true,"scalar":"uint","stride":4},{"name":"expressions","binding":2,"read_only":true,"scalar":"uint","stride":4},{"name":"changes","binding":3,"read_only":true,"scalar":"uint","stride":8},{"name":"weights","binding":4,"read_only":true,"scalar":"float","stride":4},{"name":"moved","binding":13,"read_only":false,"scalar":"float","stride":16},{"name":"mesh","binding":14,"read_only":false,"scalar":"float","stride":4}],"constants":[{"name":"static_offset_layout","offset":0,"scalar":"uint","shape":[3],"strides":[4],"used":false},{"name":"vertex_count","offset":12,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"triangle_count","offset":16,"scalar":"uint","shape":[],"strides":[],"used":false},{"name":"channels","offset":20,"scalar":"uint","shape":[],"strides":[],"used":false},{"name":"size","offset":24,"scalar":"uint","shape":[],"strides":[],"used":false},{"name":"factor","offset":28,"scalar":"uint","shape":[],"strides":[],"used":false},{"name":"reach","offset":32,"scalar":"uint","shape":[],"strides":[],"used":false},{"name":"delay","offset":36,"scalar":"uint","shape":[],"strides":[],"used":false},{"name":"texel_count","offset":40,"scalar":"uint","shape":[],"strides":[],"used":false}],"constants_binding":18,"threads":[64,1,1]},
  code: withLines(`struct Constants{@align(16)static_offset_layout_0:vec3u,@align(4)vertex_count_0:u32,@align(16)triangle_count_0:u32,@align(4)channels_0:u32,@align(8)size_0:u32,@align(4)factor_0:u32,@align(16)reach_0:u32,@align(4)delay_0:u32,@align(8)texel_count_0:u32,};
@binding(18)@group(0)var<uniform>Constants_0:Constants;
@binding(1)@group(0)var<storage,read>starts_0:array<u32>;
@binding(2)@group(0)var<storage,read>expressions_0:array<u32>;
@binding(4)@group(0)var<storage,read>weights_0:array<f32>;
@binding(3)@group(0)var<storage,read>changes_0:array<vec2u>;
@binding(0)@group(0)var<storage,read>vertices_0:array<u32>;
@binding(13)@group(0)var<storage,read_write>moved_0:array<vec4f>;
@binding(14)@group(0)var<storage,read_write>mesh_0:array<f32>;
13-14
fn unpackHalves_0(a:u32)->vec2f{return vec2f(halfAt_0(a,0u),halfAt_0(a,1u));}
fn unpackFour_0(a:vec2u)->vec4f{return vec4f(unpackHalves_0(a.x),unpackHalves_0(a.y));}
@compute@workgroup_size(64,1,1)fn SumTargets(@builtin(global_invocation_id)a:vec3u){var b=a.x;if(b>=Constants_0.vertex_count_0){return;}var c=vec4f();var d=starts_0[b];var e=c;for(;d<starts_0[b+1u];){var f=e+vec4f(weights_0[(expressions_0[d/2u]>>(16u*(d&1u)))&65535u])*unpackFour_0(changes_0[d]);d=d+1u;e=f;}var g=vertices_0[b];moved_0[g]=e;var h=0u;for(;h<3u;){mesh_0[3*g+h]=mesh_0[3*g+h]+e[h];h=h+1u;}}`, UpsampleTexels),
};

/** @type {import("../shader.js").Shader} */
export const BendTriangles = {
  ...{"stage":"comp","entry":"BendTriangles","buffers":[{"name":"corners","binding":5,"read_only":true,"scalar":"uint","stride":4},{"name":"moved","binding":13,"read_only":false,"scalar":"float","stride":16},{"name":"mesh","binding":14,"read_only":false,"scalar":"float","stride":4},{"name":"triangle_bends","binding":15,"read_only":false,"scalar":"uint","stride":8}],"constants":[{"name":"static_offset_layout","offset":0,"scalar":"uint","shape":[3],"strides":[4],"used":false},{"name":"vertex_count","offset":12,"scalar":"uint","shape":[],"strides":[],"used":false},{"name":"triangle_count","offset":16,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"channels","offset":20,"scalar":"uint","shape":[],"strides":[],"used":false},{"name":"size","offset":24,"scalar":"uint","shape":[],"strides":[],"used":false},{"name":"factor","offset":28,"scalar":"uint","shape":[],"strides":[],"used":false},{"name":"reach","offset":32,"scalar":"uint","shape":[],"strides":[],"used":false},{"name":"delay","offset":36,"scalar":"uint","shape":[],"strides":[],"used":false},{"name":"texel_count","offset":40,"scalar":"uint","shape":[],"strides":[],"used":false}],"constants_binding":18,"threads":[64,1,1]},
  code: withLines(`struct Constants{@align(16)static_offset_layout_0:vec3u,@align(4)vertex_count_0:u32,@align(16)triangle_count_0:u32,@align(4)channels_0:u32,@align(8)size_0:u32,@align(4)factor_0:u32,@align(16)reach_0:u32,@align(4)delay_0:u32,@align(8)texel_count_0:u32,};
@binding(18)@group(0)var<uniform>Constants_0:Constants;
@binding(5)@group(0)var<storage,read>corners_0:array<u32>;
@binding(13)@group(0)var<storage,read_write>moved_0:array<vec4f>;
@binding(14)@group(0)var<storage,read_write>mesh_0:array<f32>;
@binding(15)@group(0)var<storage,read_write>triangle_bends_0:array<vec2u>;
fn movedVertex_0(a:u32)->vec3f{var b=3u*a;return vec3f(mesh_0[b],mesh_0[b+1u],mesh_0[b+2u]);}
struct Frame_0{x_0:vec3f,y_0:vec3f,normal_0:vec3f,along_0:f32,shear_0:f32,height_0:f32,};
fn frameOf_0(a:vec3f,b:vec3f,c:vec3f)->Frame_0{var d:Frame_0;var e=b-a;var f=length(e);d.along_0=f;var g=e/vec3f(max(f,0.00001f));d.x_0=g;var h=c-a;var i=dot(g,h);d.shear_0=i;var j=h-vec3f(i)*g;var k=length(j);d.height_0=k;var l=j/vec3f(max(k,0.00001f));d.y_0=l;d.normal_0=cross(g,l);return d;}
fn holds_0(a:Frame_0)->bool{var b=(a.along_0>=0.00001f)&&(a.height_0>=0.00001f);return b;}
struct Bend_0{turn_0:vec4f,diagonal_0:vec3f,others_0:vec3f,own_0:vec2f,};
fn noBend_0()->Bend_0{var a:Bend_0;a.turn_0=vec4f(1f,0f,0f,0f);a.diagonal_0=vec3f(vec3i(1i));a.others_0=vec3f();a.own_0=vec2f();return a;}
fn quaternionOf_0(a:vec3f,b:vec3f,c:vec3f)->vec4f{var d=a.x;var e=1f+d;var f=b.y;var g=c.z;var h=e+f+g;var i=b.z;var j=c.y;var k=i-j;var l=c.x;var m=a.z;var n=l-m;var o=a.y;var p=b.x;var q=o-p;var r=vec4f(h,k,n,q);var s=e-f-g;var t=o+p;var u=m+l;var v=vec4f(k,s,t,u);var w:vec4f;if(s>h){w=v;}else{w=r;}var x=max(h,s);var y=1f-d;var z=y+f-g;var A=i+j;var B=vec4f(n,t,z,A);if(z>x){w=B;}var C=y-f+g;var D=vec4f(q,u,A,C);if(C>(max(x,z))){w=D;}var E=select(1i,i32(-1),(w.x<0f));return vec4f(f32(E))*w/vec4f(length(w));}
fn polar_0(a:Frame_0,b:Frame_0)->Bend_0{var c=b.along_0/a.along_0;var d=(b.shear_0-c*a.shear_0)/a.height_0;var e=b.height_0/a.height_0;var f=c+e;var g=vec2f(f,-d)/vec2f(length(vec2f(f,d)));var h=g.x;var i=vec3f(h);var j=g.y;var k=vec3f(j);var l=i*b.x_0+k*b.y_0;var m=i*b.y_0-k*b.x_0;var n:array<vec3f,3>;var o=0u;for(;o<3u;){n[o]=vec3f(a.x_0[o])*l+vec3f(a.y_0[o])*m+vec3f(a.normal_0[o])*b.normal_0;o=o+1u;}var p:Bend_0;p.turn_0=quaternionOf_0(n[0],n[1],n[2]);var q=vec3f(h*d+j*e);var r=vec3f(h*c)*a.x_0+q*a.y_0;var s=q*a.x_0+vec3f(h*e-j*d)*a.y_0;var t=a.normal_0;p.diagonal_0=r*a.x_0+s*a.y_0+t*t;p.others_0=r.xxy*a.x_0.yzz+s.xxy*a.y_0.yzz+a.normal_0.xxy*a.normal_0.yzz;p.own_0=vec2f();return p;}
26-28
fn packFour_0(a:vec4f)->vec2u{return vec2u(packBounded_0(a.xy),packBounded_0(a.zw));}
@compute@workgroup_size(64,1,1)fn BendTriangles(@builtin(global_invocation_id)a:vec3u){var b=a.x;if(b>=Constants_0.triangle_count_0){return;}var c:array<vec3f,3>;var d:array<vec3f,3>;var e=0u;for(;e<3u;){var f=corners_0[3*b+e];c[e]=moved_0[f].xyz;d[e]=movedVertex_0(f);e=e+1u;}var g=frameOf_0(d[0]-c[0],d[1]-c[1],d[2]-c[2]);var h=frameOf_0(d[0],d[1],d[2]);var i=vec3f(0f);var j=any(c[0]!=i)||any(c[1]!=i);j=j||any(c[2]!=i);var k=holds_0(g)&&holds_0(h);var l:f32;if(k){l=min(g.along_0*g.height_0,h.along_0*h.height_0)/2f;}else{l=0f;}var m=noBend_0();if(j){}else{k=false;}var n:Bend_0;if(k){n=polar_0(g,h);}else{n=m;}var o=3u*b;triangle_bends_0[o]=packFour_0(n.turn_0);triangle_bends_0[o+1u]=packFour_0(vec4f(n.diagonal_0,n.others_0.x));var p=n.others_0.yz;var q=1024f*sqrt(l);var r=select(0i,1i,j);triangle_bends_0[o+2u]=packFour_0(vec4f(p,q,f32(r)));}`, UpsampleTexels),
};

/** @type {import("../shader.js").Shader} */
export const BendVertices = {
  ...{"stage":"comp","entry":"BendVertices","buffers":[{"name":"vertices","binding":0,"read_only":true,"scalar":"uint","stride":4},{"name":"starts","binding":1,"read_only":true,"scalar":"uint","stride":4},{"name":"stars","binding":6,"read_only":true,"scalar":"uint","stride":4},{"name":"moved","binding":13,"read_only":false,"scalar":"float","stride":16},{"name":"triangle_bends","binding":15,"read_only":false,"scalar":"uint","stride":8},{"name":"vertex_bends","binding":16,"read_only":false,"scalar":"uint","stride":8}],"constants":[{"name":"static_offset_layout","offset":0,"scalar":"uint","shape":[3],"strides":[4],"used":false},{"name":"vertex_count","offset":12,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"triangle_count","offset":16,"scalar":"uint","shape":[],"strides":[],"used":false},{"name":"channels","offset":20,"scalar":"uint","shape":[],"strides":[],"used":false},{"name":"size","offset":24,"scalar":"uint","shape":[],"strides":[],"used":false},{"name":"factor","offset":28,"scalar":"uint","shape":[],"strides":[],"used":false},{"name":"reach","offset":32,"scalar":"uint","shape":[],"strides":[],"used":false},{"name":"delay","offset":36,"scalar":"uint","shape":[],"strides":[],"used":false},{"name":"texel_count","offset":40,"scalar":"uint","shape":[],"strides":[],"used":false}],"constants_binding":18,"threads":[64,1,1]},
  code: withLines(`struct Constants{@align(16)static_offset_layout_0:vec3u,@align(4)vertex_count_0:u32,@align(16)triangle_count_0:u32,@align(4)channels_0:u32,@align(8)size_0:u32,@align(4)factor_0:u32,@align(16)reach_0:u32,@align(4)delay_0:u32,@align(8)texel_count_0:u32,};
@binding(18)@group(0)var<uniform>Constants_0:Constants;
@binding(1)@group(0)var<storage,read>starts_0:array<u32>;
@binding(6)@group(0)var<storage,read>stars_0:array<u32>;
@binding(15)@group(0)var<storage,read_write>triangle_bends_0:array<vec2u>;
@binding(0)@group(0)var<storage,read>vertices_0:array<u32>;
@binding(16)@group(0)var<storage,read_write>vertex_bends_0:array<vec2u>;
@binding(13)@group(0)var<storage,read_write>moved_0:array<vec4f>;
13-14
fn unpackHalves_0(a:u32)->vec2f{return vec2f(halfAt_0(a,0u),halfAt_0(a,1u));}
fn unpackFour_0(a:vec2u)->vec4f{return vec4f(unpackHalves_0(a.x),unpackHalves_0(a.y));}
struct Bend_0{turn_0:vec4f,diagonal_0:vec3f,others_0:vec3f,own_0:vec2f,};
fn unpackBend_0(a:vec2u,b:vec2u,c:vec2u)->Bend_0{var d=unpackFour_0(b);var e=unpackFour_0(c);var f:Bend_0;f.turn_0=unpackFour_0(a);f.diagonal_0=d.xyz;f.others_0=vec3f(d.w,e.xy);f.own_0=e.zw;return f;}
fn triangleBend_0(a:u32)->Bend_0{var b=3u*a;return unpackBend_0(triangle_bends_0[b],triangle_bends_0[b+1u],triangle_bends_0[b+2u]);}
fn addTurn_0(a:vec4f,b:vec4f)->vec4f{var c=select(1i,i32(-1),(dot(a,b)<0f));return a+vec4f(f32(c))*b;}
fn noBend_0()->Bend_0{var a:Bend_0;a.turn_0=vec4f(1f,0f,0f,0f);a.diagonal_0=vec3f(vec3i(1i));a.others_0=vec3f();a.own_0=vec2f();return a;}
26-28
fn packFour_0(a:vec4f)->vec2u{return vec2u(packBounded_0(a.xy),packBounded_0(a.zw));}
@compute@workgroup_size(64,1,1)fn BendVertices(@builtin(global_invocation_id)a:vec3u){var b=a.x;if(b>=Constants_0.vertex_count_0){return;}var c=vec3f();var d=starts_0[b];var e=vec4f();var f=d;var g=c;var h=c;var i=0f;var j=0f;for(;f<starts_0[b+1u];){var k=triangleBend_0(stars_0[f]);var l=k.own_0.x;var m=l*l;var n=addTurn_0(e,vec4f(m)*k.turn_0);var o=vec3f(m);var p=g+o*k.diagonal_0;var q=h+o*k.others_0;var r=i+m;var s=j+k.own_0.y;var t=f+1u;e=n;f=t;g=p;h=q;i=r;j=s;}var u=noBend_0();var v:f32;if(j>0f){var w=i>0f;if(w){v=1f/i;}else{v=0f;}u.turn_0=vec4f(v)*e;u.diagonal_0=vec3f(v)*g;u.others_0=vec3f(v)*h;i=select(2f,1f,w);v=i;}else{v=0f;}var x=vertices_0[b];var y=3u*x;vertex_bends_0[y]=packFour_0(u.turn_0);vertex_bends_0[y+1u]=packFour_0(vec4f(u.diagonal_0,u.others_0.x));vertex_bends_0[y+2u]=packFour_0(vec4f(u.others_0.yz,moved_0[x].w,v));}`, UpsampleTexels),
};

/** @type {import("../shader.js").Shader} */
export const BendTexels = {
  ...{"stage":"comp","entry":"BendTexels","buffers":[{"name":"ll","binding":7,"read_only":true,"scalar":"uint","stride":4},{"name":"upsampling","binding":8,"read_only":true,"scalar":"float","stride":4},{"name":"tiles","binding":9,"read_only":true,"scalar":"uint","stride":8},{"name":"static_offset","binding":10,"read_only":true,"scalar":"uint","stride":4},{"name":"faces","binding":11,"read_only":true,"scalar":"uint","stride":4},{"name":"texels","binding":12,"read_only":true,"scalar":"uint","stride":8},{"name":"vertex_bends","binding":16,"read_only":false,"scalar":"uint","stride":8},{"name":"texel_channels","binding":17,"read_only":false,"scalar":"uint","stride":8}],"constants":[{"name":"static_offset_layout","offset":0,"scalar":"uint","shape":[3],"strides":[4],"used":true},{"name":"vertex_count","offset":12,"scalar":"uint","shape":[],"strides":[],"used":false},{"name":"triangle_count","offset":16,"scalar":"uint","shape":[],"strides":[],"used":false},{"name":"channels","offset":20,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"size","offset":24,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"factor","offset":28,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"reach","offset":32,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"delay","offset":36,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"texel_count","offset":40,"scalar":"uint","shape":[],"strides":[],"used":true}],"constants_binding":18,"threads":[16,16,1]},
  code: withLines(`struct Constants{@align(16)static_offset_layout_0:vec3u,@align(4)vertex_count_0:u32,@align(16)triangle_count_0:u32,@align(4)channels_0:u32,@align(8)size_0:u32,@align(4)factor_0:u32,@align(16)reach_0:u32,@align(4)delay_0:u32,@align(8)texel_count_0:u32,};
@binding(18)@group(0)var<uniform>Constants_0:Constants;
@binding(9)@group(0)var<storage,read>tiles_0:array<vec2u>;
@binding(7)@group(0)var<storage,read>ll_0:array<u32>;
@binding(8)@group(0)var<storage,read>upsampling_0:array<f32>;
@binding(10)@group(0)var<storage,read>static_offset_0:array<u32>;
@binding(12)@group(0)var<storage,read>texels_0:array<vec2u>;
@binding(11)@group(0)var<storage,read>faces_0:array<u32>;
@binding(16)@group(0)var<storage,read_write>vertex_bends_0:array<vec2u>;
@binding(17)@group(0)var<storage,read_write>texel_channels_0:array<vec2u>;
7-18
21-23
18-21
23-26
fn upsampleRows_0(a:u32,b:vec2u,c:ptr<function,array<vec4f,3>>,d:ptr<function,u32>,e:ptr<function,bool>)->bool{loadBatch_0(a,b,0u);workgroupBarrier();var f=batchAt_0(a,b);(*c)[0]=f;workgroupBarrier();loadBatch_0(a,b,4u);workgroupBarrier();var g=batchAt_0(a,b);(*c)[1]=g;workgroupBarrier();loadBatch_0(a,b,8u);workgroupBarrier();var h=batchAt_0(a,b);(*c)[2]=h;workgroupBarrier();var i=tileRow_0(a,b.y);var j=i.y;var k=b.x;var l=isIn_0(j,k);var m:u32;if(l){m=texelOf_0(i,k);}else{m=0u;}(*d)=m;(*e)=isIn_0((j>>16u),k);if(l){m=0u;for(;m<3u;){var n=withStatic_0((*c)[m],*d,4u*m);(*c)[m]=n;m=m+1u;}}return l;}
fn unpackHalves_0(a:u32)->vec2f{return vec2f(halfAt_0(a,0u),halfAt_0(a,1u));}
fn unpackFour_0(a:vec2u)->vec4f{return vec4f(unpackHalves_0(a.x),unpackHalves_0(a.y));}
struct Bend_0{turn_0:vec4f,diagonal_0:vec3f,others_0:vec3f,own_0:vec2f,};
fn unpackBend_0(a:vec2u,b:vec2u,c:vec2u)->Bend_0{var d=unpackFour_0(b);var e=unpackFour_0(c);var f:Bend_0;f.turn_0=unpackFour_0(a);f.diagonal_0=d.xyz;f.others_0=vec3f(d.w,e.xy);f.own_0=e.zw;return f;}
fn vertexBend_0(a:u32)->Bend_0{var b=3u*a;return unpackBend_0(vertex_bends_0[b],vertex_bends_0[b+1u],vertex_bends_0[b+2u]);}
fn shareOf_0(a:Bend_0,b:f32)->Bend_0{var c:Bend_0;c.turn_0=vec4f(b)*a.turn_0;var d=vec3f(b);c.diagonal_0=d*a.diagonal_0;c.others_0=d*a.others_0;var e:f32;if(a.own_0.y==2f){e=0f;}else{e=b;}c.own_0=vec2f(e,b*a.own_0.x);return c;}
fn addTurn_0(a:vec4f,b:vec4f)->vec4f{var c=select(1i,i32(-1),(dot(a,b)<0f));return a+vec4f(f32(c))*b;}
fn bendAt_0(a:u32,b:ptr<function,bool>)->Bend_0{var c=texels_0[a];var d=3u*(c.x&2147483647u);var e=c.y;var f=vec2f(f32(e&65535u),f32(e>>16u))/vec2f(65535f);var g=vec3f(f,max(1f-f.x-f.y,0f));var h=vertexBend_0(faces_0[d]);var i=shareOf_0(h,g.x);(*b)=h.own_0.y!=0f;var j=1u;for(;j<3u;){var k=vertexBend_0(faces_0[d+j]);var l=shareOf_0(k,g[j]);i.turn_0=addTurn_0(i.turn_0,l.turn_0);i.diagonal_0=i.diagonal_0+l.diagonal_0;i.others_0=i.others_0+l.others_0;i.own_0=i.own_0+l.own_0;var m=(*b)||(k.own_0.y!=0f);(*b)=m;j=j+1u;}return i;}
fn quaternionRotate_0(a:vec4f,b:vec3f)->vec3f{var c=a.yzw;var d=vec3f(2f)*cross(c,b);return b+vec3f(a.x)*d+cross(c,d);}
fn quaternionMultiply_0(a:vec4f,b:vec4f)->vec4f{var c=a.x;var d=b.x;var e=a.yzw;var f=b.yzw;return vec4f(c*d-dot(e,f),vec3f(c)*f+vec3f(d)*e+cross(e,f));}
26-29
fn writeRows_0(a:u32,b:u32,c:array<vec4f,3>){var d=0u;for(;d<3u;){writeTexel_0(a,b+d,c[d]);d=d+1u;}}
@compute@workgroup_size(16,16,1)fn BendTexels(@builtin(workgroup_id)a:vec3u,@builtin(local_invocation_id)b:vec3u){var c:array<vec4f,3>;var d:u32;var e:bool;var f=upsampleRows_0(a.x,b.xy,&c,&d,&e);if(!f){return;}if(e){var g:bool;var h=bendAt_0(d,&g);const i=vec4f(1f,0f,0f,0f);c[2][3]=h.own_0.y;var j=g&&(h.own_0.x>0f);var k:vec4f;if(j){var l=h.turn_0/vec4f(max(length(h.turn_0),1.1754944e-38f));var m=vec4f(c[0].w,c[1].xyz);var n=m/vec4f(max(length(m),1.1754944e-38f));var o=vec3f(h.diagonal_0.x,h.others_0.xy);var p=vec3f(h.others_0.x,h.diagonal_0.y,h.others_0.z);var q=vec3f(h.others_0.yz,h.diagonal_0.z);var r=array<vec3f,3>(vec3f(1f,0f,0f),vec3f(0f,1f,0f),vec3f(0f,0f,1f));var s=vec3f();var t=s;var u=s;var v=0u;for(;v<3u;){var w=quaternionRotate_0(n,r[v]);t[v]=log(clamp(length(vec3f(w.x)*o+vec3f(w.y)*p+vec3f(w.z)*q)/h.own_0.x,0.05f,20f));var x=v+1u;u=w;v=x;}var y=quaternionRotate_0(l,u);var z=vec4f(dot(u,y),cross(u,y));var A=quaternionMultiply_0(l,m);c[0]=vec4f(quaternionRotate_0(l,c[0].xyz),A.x);c[1]=vec4f(A.yzw,c[1].w+t.x);var B=c[2].xy+t.yz;c[2].x=B.x;c[2].y=B.y;k=z;}else{k=i;}writeTexel_0(d,3u,k);}writeRows_0(d,0u,c);}`, UpsampleTexels),
};

/** @type {import("../shader.js").Shader} */
export const LightTexels = {
  ...{"stage":"comp","entry":"LightTexels","buffers":[{"name":"ll","binding":7,"read_only":true,"scalar":"uint","stride":4},{"name":"upsampling","binding":8,"read_only":true,"scalar":"float","stride":4},{"name":"tiles","binding":9,"read_only":true,"scalar":"uint","stride":8},{"name":"static_offset","binding":10,"read_only":true,"scalar":"uint","stride":4},{"name":"texel_channels","binding":17,"read_only":false,"scalar":"uint","stride":8}],"constants":[{"name":"static_offset_layout","offset":0,"scalar":"uint","shape":[3],"strides":[4],"used":true},{"name":"vertex_count","offset":12,"scalar":"uint","shape":[],"strides":[],"used":false},{"name":"triangle_count","offset":16,"scalar":"uint","shape":[],"strides":[],"used":false},{"name":"channels","offset":20,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"size","offset":24,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"factor","offset":28,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"reach","offset":32,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"delay","offset":36,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"texel_count","offset":40,"scalar":"uint","shape":[],"strides":[],"used":true}],"constants_binding":18,"threads":[16,16,1]},
  code: withLines(`struct Constants{@align(16)static_offset_layout_0:vec3u,@align(4)vertex_count_0:u32,@align(16)triangle_count_0:u32,@align(4)channels_0:u32,@align(8)size_0:u32,@align(4)factor_0:u32,@align(16)reach_0:u32,@align(4)delay_0:u32,@align(8)texel_count_0:u32,};
@binding(18)@group(0)var<uniform>Constants_0:Constants;
@binding(9)@group(0)var<storage,read>tiles_0:array<vec2u>;
@binding(7)@group(0)var<storage,read>ll_0:array<u32>;
@binding(8)@group(0)var<storage,read>upsampling_0:array<f32>;
@binding(10)@group(0)var<storage,read>static_offset_0:array<u32>;
@binding(17)@group(0)var<storage,read_write>texel_channels_0:array<vec2u>;
7-18
21-23
18-21
23-26
fn upsampleRows_0(a:u32,b:vec2u,c:ptr<function,array<vec4f,3>>,d:ptr<function,u32>,e:ptr<function,bool>)->bool{loadBatch_0(a,b,0u);workgroupBarrier();var f=batchAt_0(a,b);(*c)[0]=f;workgroupBarrier();loadBatch_0(a,b,4u);workgroupBarrier();var g=batchAt_0(a,b);(*c)[1]=g;workgroupBarrier();loadBatch_0(a,b,8u);workgroupBarrier();var h=batchAt_0(a,b);(*c)[2]=h;workgroupBarrier();var i=tileRow_0(a,b.y);var j=i.y;var k=b.x;var l=isIn_0(j,k);var m:u32;if(l){m=texelOf_0(i,k);}else{m=0u;}(*d)=m;(*e)=isIn_0((j>>16u),k);if(l){m=0u;for(;m<3u;){var n=withStatic_0((*c)[m],*d,4u*m);(*c)[m]=n;m=m+1u;}}return l;}
fn unpackHalves_0(a:u32)->vec2f{return vec2f(halfAt_0(a,0u),halfAt_0(a,1u));}
fn unpackFour_0(a:vec2u)->vec4f{return vec4f(unpackHalves_0(a.x),unpackHalves_0(a.y));}
fn quaternionRotate_0(a:vec4f,b:vec3f)->vec3f{var c=a.yzw;var d=vec3f(2f)*cross(c,b);return b+vec3f(a.x)*d+cross(c,d);}
26-29
fn writeRows_0(a:u32,b:u32,c:array<vec4f,3>){var d=0u;for(;d<3u;){writeTexel_0(a,b+d,c[d]);d=d+1u;}}
@compute@workgroup_size(16,16,1)fn LightTexels(@builtin(workgroup_id)a:vec3u,@builtin(local_invocation_id)b:vec3u){var c:array<vec4f,3>;var d:u32;var e:bool;var f=upsampleRows_0(a.x,b.xy,&c,&d,&e);if(!f){return;}if(e){var g=unpackFour_0(texel_channels_0[3*Constants_0.texel_count_0+d]);var h=halfAt_0(texel_channels_0[2*Constants_0.texel_count_0+d].y,1u);var i=vec3f(c[0].w,c[1].xy);var j=vec3f(c[1].zw,c[2].x);var k=c[2].yzw;var l=0u;for(;l<3u;){var m=quaternionRotate_0(g,vec3f(-k[l],-i[l],j[l]));k[l]=-m.x;i[l]=-m.y;j[l]=m.z;l=l+1u;}c[0]=vec4f(c[0].xyz+vec3f(h)*(c[0].xyz+vec3f(1.7724538f)),i.x);c[1]=vec4f(i.yz,j.xy);c[2]=vec4f(j.z,k);}writeRows_0(d,3u,c);}`, UpsampleTexels),
};
